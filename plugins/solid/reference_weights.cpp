// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_weights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "force_consistency.hpp"
#include "monomials.hpp"
#include "pair_sums.hpp"
#include "shoal/host.hpp"
#include "shoal/smoothing_kernel.hpp"

namespace shoal::solid {
namespace {

// Loads of four numbers may begin at the last one.
constexpr std::size_t behind = 8;

// The neighbours of a particle as the fit sees them.
template <int D>
struct Surroundings {
  struct Neighbour {
    Monomials<D> p;  // of (X_j - X_i) / h
    double w;        // V_j W_ij
    double slope;    // -V_j W'_ij / r
  };
  std::vector<Neighbour> neighbours;

  void look(const WendlandC2<D>& kernel, const Row& row, const double* x, const double* volume,
            std::uint64_t i) {
    neighbours.clear();
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const std::size_t j = row.j[m];
      Vec<D> d;
      for (int a = 0; a < D; ++a)
        d[a] = x[j * D + static_cast<std::size_t>(a)] - x[i * D + static_cast<std::size_t>(a)];
      const double r = norm(d);
      neighbours.push_back(
          {monomials<D>(d / kernel.h()), volume[j] * kernel.w(r), -volume[j] * kernel.dw_over_r(r)});
    }
  }
};

// Writes G and psi of one row. `out` holds D + 1 numbers a pair.
template <int D>
class RowFit {
 public:
  static constexpr int N = n_monomials<D>;

  RowFit(const ReferenceSettings& settings) : settings_(settings), h_(settings.smoothing_length) {}

  void operator()(const Surroundings<D>& around, double* out) {
    moments_.setZero();
    first_.setZero();
    linear_.setZero();
    double s = 0;
    for (const auto& [p, w, slope] : around.neighbours) {
      moments_.noalias() += w * p * p.transpose();
      first_ += w * p;
      linear_.noalias() += slope * p.template head<D>() * p.template head<D>().transpose();
      s += w;
    }
    const double regularisation = settings_.eps * moments_.template topLeftCorner<D, D>().trace();
    for (int k = D; k < N; ++k) moments_(k, k) += regularisation;

    const bool fits = solve_quadratic();
    const bool linear_fits = (!fits || !settings_.quadratic) && solve_linear();
    for (const auto& [p, w, slope] : around.neighbours) {
      Vec<D> g{};
      if (fits && settings_.quadratic)
        for (int a = 0; a < D; ++a) g[a] = w / h_ * gradient_rows_.row(a).dot(p);
      else if (linear_fits)
        for (int a = 0; a < D; ++a) g[a] = slope / h_ * linear_inverse_.row(a).dot(p.template head<D>());
      for (int a = 0; a < D; ++a) *out++ = g[a];
      *out++ = fits ? w * (1.0 - residual_row_.dot(p)) / s : 0.0;
    }
  }

 private:
  // False if there are too few neighbours around for a quadratic fit.
  bool solve_quadratic() {
    const Eigen::LLT<Moments<D>> llt(moments_);
    if (!well_conditioned<D>(llt)) return false;
    const Eigen::Matrix<double, N, D> columns = llt.solve(Eigen::Matrix<double, N, D>::Identity());
    gradient_rows_ = columns.transpose();
    residual_row_ = llt.solve(first_);
    return true;
  }
  bool solve_linear() {
    const Eigen::LLT<Eigen::Matrix<double, D, D>> llt(linear_);
    if (llt.info() != Eigen::Success) return false;
    for (int k = 0; k < D; ++k)
      if (!(std::pow(llt.matrixLLT()(k, k), 2) > 1e-6 * linear_.trace())) return false;
    linear_inverse_ = llt.solve(Eigen::Matrix<double, D, D>::Identity());
    return true;
  }

  const ReferenceSettings& settings_;
  double h_;
  Moments<D> moments_;
  Monomials<D> first_, residual_row_;
  Eigen::Matrix<double, D, N> gradient_rows_;
  Eigen::Matrix<double, D, D> linear_, linear_inverse_;
};

}  // namespace

void AlignedNumbers::assign(std::size_t n) {
  n_ = n + behind;
  data_.reset(static_cast<double*>(::operator new[](n_ * sizeof(double), std::align_val_t(64))));
  std::fill_n(data_.get(), n_, 0.0);
}

void ReferenceWeights::build(int dimensions, const ReferenceSettings& settings, const shoal_neighbours& list,
                             const ReferenceGeometry& geometry) {
  n_ = list.n_rows;
  dimensions_ = dimensions;
  spacing_ = settings.spacing;
  stride_ = static_cast<std::size_t>(dimensions) + 1;
  offsets_.assign(n_ + 1, 0);
  for (std::uint64_t i = 0; i < n_; ++i) {
    offsets_[i + 1] = offsets_[i] + list.counts[i];
    const Row row = row_of(list, i);
    if (std::any_of(row.j, row.j + row.n, [&](std::uint32_t j) { return j >= n_; }))
      throw CaseError(
          "a solid body reaches a periodic or mirror face of the domain, which solid.total_lagrangian does "
          "not know; "
          "leave room, or hold the particles of a plane of symmetry with solid.prescribed_motion");
  }
  forward_.assign(offsets_[n_] * stride_);
  backward_.assign(offsets_[n_] * stride_);
  sums_.assign(n_ * stride_);
  dimensions == 2 ? fill<2>(settings, list, geometry) : fill<3>(settings, list, geometry);
  dimensions == 2 ? mirror<2>(list, geometry.volume) : mirror<3>(list, geometry.volume);
}

template <int D>
void ReferenceWeights::fill(const ReferenceSettings& settings, const shoal_neighbours& list,
                            const ReferenceGeometry& geometry) {
  const WendlandC2<D> kernel(settings.smoothing_length);
  Surroundings<D> around;
  RowFit<D> fit(settings);
  for (std::uint64_t i = 0; i < n_; ++i) {
    around.look(kernel, row_of(list, i), geometry.position, geometry.volume, i);
    fit(around, forward_.data() + offsets_[i] * stride_);
  }
  if (!settings.consistent) return;
  consistency_ = make_consistent<D>(settings, list, geometry, offsets_, forward_.data());
}

template <int D>
void ReferenceWeights::mirror(const shoal_neighbours& list, const double* volume) {
  constexpr std::size_t S = D + 1;
  for (std::uint64_t i = 0; i < n_; ++i) {
    const Row row = row_of(list, i);
    double* sums = sums_.data() + i * S;
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const std::size_t j = row.j[m];
      const Row theirs = row_of(list, j);
      const auto place = static_cast<std::size_t>(
          std::find(theirs.j, theirs.j + theirs.n, static_cast<std::uint32_t>(i)) - theirs.j);
      const double* there = forward_.data() + (offsets_[j] + place) * S;
      const double* here = forward_.data() + (offsets_[i] + m) * S;
      double* back = backward_.data() + (offsets_[i] + m) * S;
      for (std::size_t k = 0; k < S; ++k) {
        back[k] = place < theirs.n ? volume[j] / volume[i] * there[k] : 0.0;
        sums[k] += here[k];
      }
    }
  }
}

void ReferenceWeights::residual(std::uint64_t i, std::uint32_t count, double* out) const {
  const auto d = static_cast<std::size_t>(dimensions_);
  std::copy_n(sums(i), d, out);
  const double* back = backward(i);
  for (std::uint32_t m = 0; m < count; ++m)
    for (std::size_t k = 0; k < d; ++k) out[k] -= back[m * stride_ + k];
}

std::uint64_t ReferenceWeights::bytes() const {
  return sizeof(double) * (forward_.size() + backward_.size() + sums_.size()) +
         sizeof(std::uint64_t) * offsets_.size();
}

// Numbers without any symmetry.
void ReferenceWeights::random_start(AlignedNumbers& u) const {
  u.assign(n_ * static_cast<std::size_t>(dimensions_));
  std::uint64_t random = 88172645463325252u;  // xorshift
  for (std::size_t k = 0; k < n_ * static_cast<std::size_t>(dimensions_); ++k) {
    random ^= random << 13, random ^= random >> 7, random ^= random << 17;
    u.data()[k] = static_cast<double>(random >> 11) * 0x1p-53 - 0.5;
  }
}

template <int D>
void ReferenceWeights::linear_force(const shoal_neighbours& list, const Stiffness& stiffness, const double* u,
                                    double* out, LinearSpace& space) const {
  if (space.stress.size() == 0) space.stress.assign(n_ * D * D), space.held.assign(n_ * D);
  const double q_factor = stiffness.hourglass / (spacing_ * spacing_);
  for (std::uint64_t i = 0; i < n_; ++i) {
    const auto [gradient, residual] = deformation<D>(row_of(list, i), forward(i), u, i);
    const Mat<D> strain = symmetric_part(gradient);
    const Mat<D> s = stiffness.lambda * trace(strain) * identity<D>() + 2.0 * stiffness.mu * strain;
    std::copy_n(s.e, D * D, space.stress.data() + i * D * D);
    for (int a = 0; a < D; ++a)
      space.held.data()[i * D + static_cast<std::size_t>(a)] = q_factor * residual[a];
  }
  for (std::uint64_t i = 0; i < n_; ++i) {
    const Vec<D> f =
        force<D, true>(row_of(list, i), backward(i), sums(i), space.stress.data(), space.held.data(), i);
    for (int a = 0; a < D; ++a) out[i * D + static_cast<std::size_t>(a)] = f[a];
  }
}

void ReferenceWeights::linear_force(const shoal_neighbours& list, const Stiffness& stiffness, const double* u,
                                    double* out, LinearSpace& space) const {
  dimensions_ == 2 ? linear_force<2>(list, stiffness, u, out, space)
                   : linear_force<3>(list, stiffness, u, out, space);
}

// Small displacements u of an isotropic body: w^2 is the largest eigenvalue of u -> -f(u) / rho.
double ReferenceWeights::largest_frequency(const shoal_neighbours& list, const Stiffness& stiffness) const {
  constexpr int iterations = 60;
  const std::size_t n = n_ * static_cast<std::size_t>(dimensions_);
  AlignedNumbers u, f;
  random_start(u);
  f.assign(n);
  LinearSpace space;
  double square = 0;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    double length = 0, along = 0;
    for (std::size_t k = 0; k < n; ++k) length += u.data()[k] * u.data()[k];
    const double scale = 1.0 / std::sqrt(length);
    for (std::size_t k = 0; k < n; ++k) u.data()[k] *= scale;
    linear_force(list, stiffness, u.data(), f.data(), space);
    for (std::size_t k = 0; k < n; ++k) {
      f.data()[k] *= -1.0 / stiffness.density;
      along += u.data()[k] * f.data()[k];
    }
    square = along;
    std::swap(u, f);
  }
  return std::sqrt(std::max(0.0, square));
}

}  // namespace shoal::solid
