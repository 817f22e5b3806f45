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
// Surface points b within reach, each of area dx^(d-1):
//   C_i dc_i/dt += f_i sum_b 2 W_ib area q_b,   q_b what enters: g, or K (c_b - c_i) over the distance to the surface
//   f_i such that f_i sum_b W_ib area n_b is what the kernel misses, -sum_j V_j grad W_ij: then a linear c is steady.
// Without f_i errors were five times as large. Where surfaces matter take the accurate scheme.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "correction.hpp"
#include "small_matrix.hpp"
#include "spectral_radius.hpp"
#include "stencil.hpp"
#include "surface.hpp"

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

// The weights of pairs, and what the schemes have in common.
class WeightsOfPairs : public RowOperator {
 public:
  In<Vector> position{"position"};
  In<Scalar> volume{"volume", neighbours_only};
  std::unique_ptr<In<Scalar>> scalar;
  std::unique_ptr<In<Matrix>> tensor;
  std::unique_ptr<In<Matrix>> correction;
  std::unique_ptr<SurfacePoints> points;
  Maximum row_sum;

  std::shared_ptr<Stencil> stencil;
  double capacity = 1;                // J/(m3 K), or 1
  std::vector<double> capacities;     // of the bodies of the relations
  std::size_t first_wall = SIZE_MAX;  // relations from here on are with walls
  double lattice_spacing = 0;         // m, of the lattice that sums are normalised on; 0: that of the body
  bool moving = false;                // no power iteration then: weights are renewed all the time

  void set(const std::string& field, bool isotropic, std::shared_ptr<Stencil> weights) {
    const char* name = names_.keep(conductivity_of(field));
    if (isotropic)
      scalar = std::make_unique<In<Scalar>>(name);
    else
      tensor = std::make_unique<In<Matrix>>(name);
    stencil = std::move(weights);
  }
  void correct_gradient() { correction = std::make_unique<In<Matrix>>(GradientCorrection::field); }
  void set_surface(const std::string& field, const std::vector<Condition>& conditions) {
    points = std::make_unique<SurfacePoints>(names_.keep(surface_of(field)));
    points->conditions = conditions;
  }

  void begin() { active_ = renew_stencil(*this, *stencil); }
  void end() {
    if (!active_) return;
    // 2 max_i sum_j |l_ij| bounds all eigenvalues (Gershgorin), by a factor of 1.5 to 4 too high.
    stencil->spectral_radius = 2.0 * row_sum.result();
    if (stencil->limited) stencil->limiter_rate = limiter_bound * largest_sum();
    if (moving) return;
    double radius = spectral_radius(StencilMatrix(*this, *stencil, false));
    if (stencil->limited) radius = std::max(radius, spectral_radius(StencilMatrix(*this, *stencil, true)));
    stencil->spectral_radius = std::min(stencil->spectral_radius, spectral_margin * radius);
  }
  void save(const shoal_stream& stream) const {
    check_host(stream.write(stream.context, &stencil->spectral_radius, sizeof(double)));
    check_host(stream.write(stream.context, &stencil->limiter_rate, sizeof(double)));
  }
  void load(const shoal_stream& stream) {
    check_host(stream.read(stream.context, &stencil->spectral_radius, sizeof(double)));
    check_host(stream.read(stream.context, &stencil->limiter_rate, sizeof(double)));
  }

 protected:
  bool active() const { return active_; }

  // K of particle j of a relation, as a tensor.
  template <int D>
  Mat<D> tensor_of(std::size_t k, std::uint32_t j) const {
    if (scalar) return scalar->of_neighbours(k)[j] * identity<D>();
    return gather_mat<D>(tensor->of_neighbours(k), j);
  }
  template <int D>
  Mat<D> own_tensor(std::uint64_t i) const {
    if (scalar) return scalar->data()[i] * identity<D>();
    return (*tensor)[Particle<D>{i, nullptr}];
  }

  // The row of the conservative scheme; returns sum_j |l_ij|.
  template <int D, class Kernel>
  double pairwise_row(const Kernel& kernel, const LatticeMoments<D>& lattice, std::uint64_t i,
                      std::vector<SurfaceWeight>& surface) const {
    double total = 0;
    const Vec<D> x_i = position[Particle<D>{i, nullptr}];
    const std::size_t first = surface.size();
    Vec<D> missing{},
        of_points{};  // gradient of the volume that the kernel sees, and what surface points say of it
    if (points) surface_point<D>(kernel, i, -1, static_cast<std::uint32_t>(i), surface, of_points);
    for (std::size_t k = 0; k < n_relations(); ++k) {
      const shoal_neighbours& list = neighbours(k);
      for (std::uint64_t entry = list.offsets[i]; entry < list.offsets[i] + list.counts[i]; ++entry) {
        const std::uint32_t j = list.indices[entry];
        const Vec<D> r_ij = x_i - gather_vec<D>(position.of_neighbours(k), j);
        const double r = norm(r_ij);
        const Vec<D> e = (1.0 / std::max(r, 1e-200)) * r_ij;
        const double slope_of_pair =
            normalise<D>(lattice, k, i, j, e) * volume.of_neighbours(k)[j] * kernel.dw_over_r(r);
        const double w = -2.0 / capacity * slope_of_pair * coupling<D>(lattice, k, i, j, e);
        stencil->weights[k][entry] = w;
        total += std::abs(w);
        if (!points) continue;
        missing += slope_of_pair * r_ij;
        if (k == 0) surface_point<D>(kernel, i, 0, j, surface, of_points);
      }
    }
    const double size = squared_norm(of_points);
    const double scale = size > 0.0 ? std::max(0.0, -dot(missing, of_points) / size) : 0.0;
    for (std::size_t k = first; k < surface.size(); ++k) {
      surface[k].per_data *= scale;
      surface[k].per_value *= scale;
      total += surface[k].per_value;
    }
    return total;
  }

 private:
  // Of the kernel's gradient: on the lattice, or by the correction of the two particles.
  template <int D>
  double normalise(const LatticeMoments<D>& lattice, std::size_t k, std::uint64_t i, std::uint32_t j,
                   const Vec<D>& e) const {
    if (!correction) return 1.0 / lattice.slope();
    const auto along = [&](const Mat<D>& of_one) { return dot(e, of_one * e); };
    return std::max(0.0, 0.5 * (along((*correction)[Particle<D>{i, nullptr}]) +
                                along(gather_mat<D>(correction->of_neighbours(k), j))));
  }

  // k_ij
  template <int D>
  double coupling(const LatticeMoments<D>& lattice, std::size_t k, std::uint64_t i, std::uint32_t j,
                  const Vec<D>& e) const {
    if (scalar) return harmonic(scalar->data()[i], scalar->of_neighbours(k)[j]);
    const auto along = [&](const Mat<D>& tensor_of_one) { return dot(e, lattice.b_of(tensor_of_one) * e); };
    // b_of() is normalised on the lattice already.
    return lattice.slope() * harmonic(along(own_tensor<D>(i)), along(tensor_of<D>(k, j)));
  }

  // Appends the weight of the surface point that particle j carries, if it has one with data, and adds its share of the
  // surface.
  template <int D, class Kernel>
  void surface_point(const Kernel& kernel, std::uint64_t i, int relation, std::uint32_t j,
                     std::vector<SurfaceWeight>& surface, Vec<D>& of_points) const {
    const auto point = points->template at<D>(*this, relation, j);
    if (point.number < 1) return;
    const Vec<D> x = point.place - position[Particle<D>{i, nullptr}];
    const double share = kernel.w(norm(x)) * std::pow(spacing(), D - 1);
    if (!(share > 0.0)) return;
    of_points += share * point.normal;
    if (point.number < 2) return;
    // A c_s + B q = g and q = K (c_s - c_i) / distance
    const Condition& condition = points->conditions[static_cast<std::size_t>(point.number - 2)];
    const double per_length =
        dot(point.normal, own_tensor<D>(i) * point.normal) / std::max(dot(x, point.normal), 0.25 * spacing());
    const double q = 2.0 / capacity * share * per_length / (condition.a + condition.b * per_length);
    surface.push_back({static_cast<std::uint32_t>(i), j, relation, q, q * condition.a, 0.0, 0.0});
  }

  // Of the weights of a particle, and of what pulls it to given values at the surface.
  double largest_sum() const {
    std::vector<double> sums(n_particles());
    for (std::size_t k = 0; k < n_relations(); ++k)
      for (std::size_t i = 0; i < sums.size(); ++i)
        for (std::uint32_t m = 0; m < neighbours(k).counts[i]; ++m)
          sums[i] += stencil->weights[k][neighbours(k).offsets[i] + m];
    for (const auto& chunk : stencil->surface)
      for (const SurfaceWeight& w : chunk) sums[w.i] += w.per_value;
    return sums.empty() ? 0.0 : *std::max_element(sums.begin(), sums.end());
  }

  Names names_;
  bool active_ = false;
};

// Computes the weights of the conservative scheme where particles have moved since the last time.
struct PairwiseWeights : WeightsOfPairs {
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if (!active()) return;
    auto& surface = stencil->surface_of(chunk);
    with_kernel<D>(target().smoothing_kernel, smoothing_length(), [&](const auto& kernel) {
      const LatticeMoments<D> lattice(kernel, lattice_spacing > 0.0 ? lattice_spacing : spacing());
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i)
        row_sum.update(Particle<D>{i, chunk.partial}, pairwise_row<D>(kernel, lattice, i, surface));
    });
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }
};

}  // namespace shoal::diffusion
