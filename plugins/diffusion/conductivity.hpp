// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The coefficient K of each particle, from the medium of its body, once before the first step:
//   isotropic    K = k(x)                                scalar field <field>_conductivity, m2/s or W/(m K)
//   anisotropic  K = k(x) T(x),                          matrix field of the same name
//                T given, or across I + (1 - across) f f, f the unit vector of the fibres
// K must be positive definite: checked particle by particle.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "medium.hpp"
#include "reaction/wave_speed.hpp"
#include "shoal/particle_operator.hpp"
#include "species.hpp"

namespace shoal::diffusion {

namespace impl {

// Values of an expression at particles begin <= i < end.
inline std::vector<double> values(const Expression& expression, int dimensions, const double* position,
                                  std::uint64_t begin, std::uint64_t end) {
  std::vector<double> out(end - begin);
  expression.evaluate(dimensions, end - begin, position + begin * static_cast<std::uint64_t>(dimensions), 0.0,
                      out.data());
  return out;
}

[[noreturn]] inline void not_positive(const std::string& field, const double* x, int dimensions) {
  std::string place = std::to_string(x[0]);
  for (int a = 1; a < dimensions; ++a) place += ", " + std::to_string(x[a]);
  throw CaseError("the coefficient of diffusion of '" + field + "' is not positive at (" + place +
                  "); its tensor must be symmetric and positive definite everywhere");
}

}  // namespace impl

struct ScalarConductivity : ParticleOperator<ScalarConductivity> {
  In<Vector> position{"position"};
  Out<Scalar> conductivity{"conductivity"};

  std::string field;
  Conductivity medium;
  std::shared_ptr<const WaveSpeedCorrection> correction;  // or null
  Names names;

  void set(const std::string& species, const Conductivity& k) {
    field = species;
    medium = k;
    conductivity.rename(names.keep(conductivity_of(species)));
  }
  void block(std::uint64_t begin, std::uint64_t end) const {
    const auto k = impl::values(medium.factor, dimensions(), position.data(), begin, end);
    for (std::uint64_t i = begin; i < end; ++i) {
      if (!(k[i - begin] > 0.0))
        impl::not_positive(field, position.data() + i * static_cast<std::uint64_t>(dimensions()),
                           dimensions());
      conductivity.data()[i] = correction ? (*correction)(k[i - begin]) : k[i - begin];
    }
  }
};

struct TensorConductivity : ParticleOperator<TensorConductivity> {
  In<Vector> position{"position"};
  Out<Matrix> conductivity{"conductivity"};
  std::unique_ptr<In<Matrix>> tensor_field;

  std::string field;
  Conductivity medium;
  std::shared_ptr<const WaveSpeedCorrection> correction;  // or null
  Names names;

  void set(const std::string& species, const Conductivity& k) {
    field = species;
    medium = k;
    conductivity.rename(names.keep(conductivity_of(species)));
    if (!k.tensor_field.empty()) tensor_field = std::make_unique<In<Matrix>>(names.keep(k.tensor_field));
  }

  void block(std::uint64_t begin, std::uint64_t end) const {
    dimensions() == 2 ? fill<2>(begin, end) : fill<3>(begin, end);
  }

 private:
  template <int D>
  void fill(std::uint64_t begin, std::uint64_t end) const {
    const auto evaluate = [&](const Expression& e) {
      return impl::values(e, D, position.data(), begin, end);
    };
    const auto k = evaluate(medium.factor);
    std::vector<std::vector<double>> parts;
    for (const Expression& e : medium.tensor.empty() ? medium.fibre : medium.tensor)
      parts.push_back(evaluate(e));
    if (!medium.fibre.empty()) parts.push_back(evaluate(medium.across));
    for (std::uint64_t i = begin; i < end; ++i) {
      const Mat<D> tensor = tensor_at<D>(Particle<D>{i, nullptr}, i - begin, parts);
      const Mat<D> result = k[i - begin] * tensor;
      if (!positive_definite(result)) impl::not_positive(field, position.data() + i * D, D);
      conductivity[Particle<D>{i, nullptr}] = correction ? (*correction)(result) : result;
    }
  }

  template <int D>
  Mat<D> tensor_at(Particle<D> i, std::size_t n, const std::vector<std::vector<double>>& parts) const {
    if (tensor_field) return (*tensor_field)[i];
    Mat<D> t{};
    if (!medium.tensor.empty()) {
      std::size_t c = 0;
      for (int a = 0; a < D; ++a)
        for (int b = a; b < D; ++b) t(a, b) = t(b, a) = parts[c++][n];
      return t;
    }
    Vec<D> f{};
    for (int a = 0; a < D; ++a) f[a] = parts[static_cast<std::size_t>(a)][n];
    const double across = parts.back()[n];
    return across * identity<D>() + (1.0 - across) / squared_norm(f) * outer(f, f);
  }

  template <int D>
  static bool positive_definite(const Mat<D>& k) {
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < a; ++b)
        if (!(std::abs(k(a, b) - k(b, a)) <= 1e-12 * std::abs(trace(k)))) return false;
    double last = determinant(k);
    if constexpr (D == 3) {
      const double minor = k(0, 0) * k(1, 1) - k(0, 1) * k(1, 0);
      if (!(minor > 0.0)) return false;
    }
    return k(0, 0) > 0.0 && last > 0.0;
  }
};

}  // namespace shoal::diffusion
