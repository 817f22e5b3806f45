// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The conservative scheme:  C_i dc_i/dt = sum_j 2 V_j k_ij (c_i - c_j) W'(r) / r        (Brookshaw 1985, Cleary and
// Monaghan 1999), V_i C_i dc_i/dt antisymmetric in i and j, so that the content of all particles together is kept to
// rounding, and nothing passes a surface.
//   C     capacity: 1, or rho c_p in J/(m3 K)
//   k_ij  2 k_i k_j / (k_i + k_j) of k_i = e . B_i e along the pair: continuous flux where K jumps
//   B_i   K_i where it is isotropic; else the tensor with sum_j V_j (-W' r) (e . B e) e e = K on the lattice of the
//         initial spacing (in the limit of many neighbours ((d + 2) K - tr K) / 2, Espanol and Revenga 2003), without
//         which the error of an anisotropic K would not vanish with the spacing. B is indefinite where K of one
//         direction is more than about three times that of another: heat then flows uphill along some pairs.
//         k_ij is the mean there.
// The isotropic sum is normalised on the lattice in the same way.
#pragma once

#include <cmath>
#include <memory>

#include "small_matrix.hpp"
#include "stencil.hpp"

namespace shoal::diffusion {

// The map from K to B in D dimensions, symmetric tensors as xx, xy, yy or xx, xy, xz, yy, yz, zz.
template <int D>
class LatticeMoments {
 public:
  static constexpr int terms = D * (D + 1) / 2;

  LatticeMoments() = default;
  template <class Kernel>
  LatticeMoments(const Kernel& kernel, double dx) {
    to_b_ = {};
    const int n = static_cast<int>(kernel.cutoff() / dx) + 1;
    const int depth = D == 3 ? n : 0;
    const double volume = std::pow(dx, D);
    for (int a = -n; a <= n; ++a)
      for (int b = -n; b <= n; ++b)
        for (int c = -depth; c <= depth; ++c) {
          if (a == 0 && b == 0 && c == 0) continue;
          const double x[3] = {a * dx, b * dx, c * dx};
          const double r = dx * std::sqrt(static_cast<double>(a * a + b * b + c * c));
          const double w = -volume * kernel.dw_over_r(r);
          slope_ += w * x[0] * x[0];
          for (int p = 0; p < terms; ++p)
            for (int q = 0; q < terms; ++q) {
              const double twice = row(q) == column(q) ? 1.0 : 2.0;
              to_b_(p, q) += w * twice * x[row(p)] * x[column(p)] * x[row(q)] * x[column(q)] / (r * r);
            }
        }
    invert(to_b_);
  }

  // Sum over the lattice of V (-W'/r) x^2, 1 in the limit of many neighbours.
  double slope() const { return slope_; }
  Mat<D> b_of(const Mat<D>& k) const {
    Mat<D> b{};
    for (int p = 0; p < terms; ++p) {
      double sum = 0;
      for (int q = 0; q < terms; ++q) sum += to_b_(p, q) * k(row(q), column(q));
      b(row(p), column(p)) = b(column(p), row(p)) = sum;
    }
    return b;
  }

 private:
  static constexpr int row(int p) { return D == 2 ? (p == 2) : (p < 3 ? 0 : p < 5 ? 1 : 2); }
  static constexpr int column(int p) { return D == 2 ? (p > 0) : (p < 3 ? p : p < 5 ? p - 2 : 2); }

  double slope_ = 0;
  SmallMatrix<terms> to_b_;
};

inline double harmonic(double a, double b) {
  return a > 0.0 && b > 0.0 ? 2.0 * a * b / (a + b) : 0.5 * (a + b);
}

// Computes the weights of pairs where particles have moved since the last time.
struct PairwiseWeights : RowOperator {
  In<Vector> position{"position"};
  In<Scalar> volume{"volume", neighbours_only};
  std::unique_ptr<In<Scalar>> scalar;
  std::unique_ptr<In<Matrix>> tensor;
  Maximum row_sum;

  std::shared_ptr<Stencil> stencil;
  double capacity = 1;  // J/(m3 K), or 1
  Names names;

  void set(const std::string& field, bool isotropic, std::shared_ptr<Stencil> weights) {
    const char* name = names.keep(conductivity_of(field));
    if (isotropic)
      scalar = std::make_unique<In<Scalar>>(name);
    else
      tensor = std::make_unique<In<Matrix>>(name);
    stencil = std::move(weights);
  }

  void begin() { active_ = renew_stencil(*this, *stencil); }
  void end() {
    if (active_) stencil->largest_row = row_sum.result();
  }
  void save(const shoal_stream& stream) const {
    check_host(stream.write(stream.context, &stencil->largest_row, sizeof(double)));
  }
  void load(const shoal_stream& stream) {
    check_host(stream.read(stream.context, &stencil->largest_row, sizeof(double)));
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if (!active_) return;
    with_kernel<D>(target().smoothing_kernel, smoothing_length(), [&](const auto& kernel) {
      const LatticeMoments<D> lattice(kernel, spacing());
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
        row_sum.update(Particle<D>{i, chunk.partial}, fill_row<D>(kernel, lattice, i));
    });
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }

 private:
  template <int D, class Kernel>
  double fill_row(const Kernel& kernel, const LatticeMoments<D>& lattice, std::uint64_t i) const {
    double total = 0;
    const Vec<D> x_i = position[Particle<D>{i, nullptr}];
    for (std::size_t k = 0; k < n_relations(); ++k) {
      const shoal_neighbours& list = neighbours(k);
      for (std::uint64_t entry = list.offsets[i]; entry < list.offsets[i] + list.counts[i]; ++entry) {
        const std::uint32_t j = list.indices[entry];
        const Vec<D> r_ij = x_i - gather_vec<D>(position.of_neighbours(k), j);
        const double r = norm(r_ij);
        const double w = -2.0 / capacity * volume.of_neighbours(k)[j] * kernel.dw_over_r(r) *
                         coupling<D>(lattice, k, i, j, (1.0 / std::max(r, 1e-200)) * r_ij);
        stencil->weights[k][entry] = w;
        total += std::abs(w);
      }
    }
    return total;
  }

  template <int D>
  double coupling(const LatticeMoments<D>& lattice, std::size_t k, std::uint64_t i, std::uint32_t j,
                  const Vec<D>& e) const {
    if (scalar) return harmonic(scalar->data()[i], scalar->of_neighbours(k)[j]) / lattice.slope();
    const auto along = [&](const Mat<D>& tensor_of_one) { return dot(e, lattice.b_of(tensor_of_one) * e); };
    return harmonic(along((*tensor)[Particle<D>{i, nullptr}]),
                    along(gather_mat<D>(tensor->of_neighbours(k), j)));
  }

  bool active_ = false;
};

}  // namespace shoal::diffusion
