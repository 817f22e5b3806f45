// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "force_consistency.hpp"
#include "monomials.hpp"
#include "shoal/host.hpp"
#include "shoal/smoothing_kernel.hpp"

namespace shoal::solid {
namespace {

// Weights that differ by less, over the largest of the row, are those of the same place of a lattice.
constexpr double same_weight = 1e-9;
// Rows with the same neighbours that one more is compared with.
constexpr std::size_t most_candidates = 64;

// |sum_j w_ij (X_j - X_i) / h| over sum_j w_ij is 0.38 at a flat surface of a lattice and 0.69 at a corner in 2D, 0.27,
// 0.43 and 0.62 at a surface, an edge and a corner in 3D, within 0.07 for supports of 2.1 to 3 spacings.
constexpr double asymmetry_of_corners = 0.53;
constexpr double more_at_corners = 100.0;  // of eps

// The layer next to a flat surface is below it, the surface above.
constexpr double asymmetry_of_surfaces = 0.15;
// Radius within which the hourglass residual looks but at surfaces, over the spacing: two spacings along an axis.
constexpr double near = 2.1;

// The neighbours of a particle as the fit sees them.
template <int D>
struct Surroundings {
  struct Neighbour {
    Monomials<D> p;  // of (X_j - X_i) / h
    double w;        // V_j W_ij
    double slope;    // -V_j W'_ij / r
    double even;     // v_ij, of the hourglass residual
    double volume;
  };
  std::vector<Neighbour> neighbours;

  void look(const WendlandC2<D>& kernel, double spacing, const Row& row, const ReferenceGeometry& geometry,
            std::uint64_t i) {
    neighbours.clear();
    const double* x = geometry.position;
    const HeldSurface* held = geometry.held;
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const std::size_t j = row.j[m];
      Vec<D> d;
      for (int a = 0; a < D; ++a)
        d[a] = x[j * D + static_cast<std::size_t>(a)] - x[i * D + static_cast<std::size_t>(a)];
      double volume = geometry.volume[j];
      if (held != nullptr && (held->holds(i) || held->holds(j))) {
        if (held->holds(i) || !held->shows(j)) volume = 0.0;
        for (int a = 0; a < D; ++a) d[a] -= held->shift[j * D + static_cast<std::size_t>(a)];
      }
      const double r = norm(d), reach = 2.0 * kernel.h();
      neighbours.push_back({monomials<D>(d / kernel.h()), volume * kernel.w(r), -volume * kernel.dw_over_r(r),
                            volume * std::max(0.0, 1.0 - r * r / (reach * reach)), volume});
    }
    if (near * spacing > 2.0 * kernel.h() || one_sided() > asymmetry_of_surfaces) return;
    for (Neighbour& j : neighbours)
      j.even = j.p.template head<D>().norm() * kernel.h() < near * spacing ? j.volume : 0.0;
  }

 private:
  double one_sided() const {
    Eigen::Matrix<double, D, 1> first = Eigen::Matrix<double, D, 1>::Zero();
    double sum = 0;
    for (const Neighbour& j : neighbours) first += j.w * j.p.template head<D>(), sum += j.w;
    return sum > 0.0 ? first.norm() / sum : 1.0;
  }
};

// Writes G and psi of one row. `out` holds D + 1 numbers a pair.
template <int D>
class RowFit {
 public:
  static constexpr int N = n_monomials<D>;

  RowFit(const ReferenceSettings& settings) : settings_(settings), h_(settings.smoothing_length) {}

  // Writes the weights of a particle's neighbours; false if these do not span the space, and the weights are zero.
  bool operator()(const Surroundings<D>& around, double* out) {
    sum_moments(around);
    const bool fits = solve_gradient(), controls = solve_residual();
    const bool linear_fits = (!fits || !settings_.quadratic) && solve_linear();
    for (const auto& [p, w, slope, even, volume] : around.neighbours) {
      Vec<D> g{};
      if (fits && settings_.quadratic)
        for (int a = 0; a < D; ++a) g[a] = w / h_ * gradient_rows_.row(a).dot(p);
      else if (linear_fits)
        for (int a = 0; a < D; ++a) g[a] = slope / h_ * linear_inverse_.row(a).dot(p.template head<D>());
      for (int a = 0; a < D; ++a) *out++ = g[a];
      *out++ = controls ? even * (1.0 - residual_row_.dot(p)) / sum_even_ : 0.0;
    }
    return fits || linear_fits;
  }

 private:
  void sum_moments(const Surroundings<D>& around) {
    moments_.setZero(), even_moments_.setZero();
    first_.setZero(), even_first_.setZero();
    linear_.setZero();
    sum_ = sum_even_ = 0;
    for (const auto& [p, w, slope, even, volume] : around.neighbours) {
      const Moments<D> square = p * p.transpose();
      moments_ += w * square;
      first_ += w * p;
      linear_ += slope * square.template topLeftCorner<D, D>();
      sum_ += w;
      even_moments_ += even * square;
      even_first_ += even * p;
      sum_even_ += even;
    }
  }
  // False if there are too few neighbours around for a quadratic fit.
  bool solve_gradient() {
    const double linear_moments = moments_.template topLeftCorner<D, D>().trace();
    const bool corner = first_.template head<D>().norm() > asymmetry_of_corners * sum_;
    const auto regularise = [&](double eps) {
      for (int k = D; k < N; ++k) moments_(k, k) += eps * linear_moments;
    };
    regularise(settings_.eps);
    const Eigen::LLT<Moments<D>> llt(moments_);
    if (!well_conditioned<D>(llt)) return false;
    if (!corner) return take_gradient(llt), true;
    regularise((more_at_corners - 1.0) * settings_.eps);
    take_gradient(Eigen::LLT<Moments<D>>(moments_));
    return true;
  }
  bool solve_residual() {
    const Eigen::LLT<Moments<D>> llt(even_moments_);
    if (!well_conditioned<D>(llt)) return false;
    residual_row_ = llt.solve(even_first_);
    return true;
  }
  void take_gradient(const Eigen::LLT<Moments<D>>& llt) {
    const Eigen::Matrix<double, N, D> columns = llt.solve(Eigen::Matrix<double, N, D>::Identity());
    gradient_rows_ = columns.transpose();
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
  double sum_ = 0, sum_even_ = 0;
  Moments<D> moments_, even_moments_;
  Monomials<D> first_, even_first_, residual_row_;
  Eigen::Matrix<double, D, N> gradient_rows_;
  Eigen::Matrix<double, D, D> linear_, linear_inverse_;
};

}  // namespace

ReferenceRows::ReferenceRows(int dimensions, const ReferenceSettings& settings, const shoal_neighbours& list,
                             const ReferenceGeometry& geometry)
    : stride_(static_cast<std::size_t>(dimensions) + 1), start_(list.n_rows + 1, 0) {
  for (std::uint64_t i = 0; i < list.n_rows; ++i) {
    start_[i + 1] = start_[i] + list.counts[i];
    const Row row = row_of(list, i);
    if (std::any_of(row.j, row.j + row.n, [&](std::uint32_t j) { return j >= list.n_rows; }))
      throw CaseError(
          "a solid body reaches a periodic or mirror face of the domain, which solids do not know; "
          "leave room, or hold the particles of a plane of symmetry with solid.clamp and its axes");
  }
  forward_.assign(start_.back() * stride_, 0.0);
  dimensions == 2 ? fit<2>(settings, list, geometry) : fit<3>(settings, list, geometry);
  sort(list);
  share();
}

template <int D>
void ReferenceRows::fit(const ReferenceSettings& settings, const shoal_neighbours& list,
                        const ReferenceGeometry& geometry) {
  const WendlandC2<D> kernel(settings.smoothing_length);
  Surroundings<D> around;
  RowFit<D> fitted(settings);
  bool spans = false;
  for (std::uint64_t i = 0; i < size(); ++i) {
    around.look(kernel, settings.spacing, row_of(list, i), geometry, i);
    spans = fitted(around, forward_.data() + start_[i] * stride_) || spans;
  }
  if (!spans && size() > 0)
    throw CaseError(
        "the particles of a solid body lie in one row or layer, which says nothing of how it deforms across; "
        "make "
        "it at least two particles thick, with a smaller resolution or a thicker shape");
  if (settings.consistent)
    consistency_ = make_consistent<D>(settings, list, geometry, start_, forward_.data());
}

void ReferenceRows::sort(const shoal_neighbours& list) {
  j_.resize(start_.back());
  std::vector<std::uint32_t> order;
  std::vector<double> weights;
  for (std::uint64_t i = 0; i < size(); ++i) {
    const Row row = row_of(list, i);
    order.resize(row.n);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return row.j[a] < row.j[b]; });
    double* here = forward_.data() + start_[i] * stride_;
    weights.assign(here, here + row.n * stride_);
    for (std::uint32_t m = 0; m < row.n; ++m) {
      j_[start_[i] + m] = row.j[order[m]];
      std::copy_n(weights.data() + order[m] * stride_, stride_, here + m * stride_);
    }
  }
}

// Gives rows that are the same but for rounding the same numbers: those of the first of them.
void ReferenceRows::share() {
  std::unordered_map<std::uint64_t, std::vector<std::uint64_t>> known;
  for (std::uint64_t i = 0; i < size(); ++i) {
    const std::uint32_t n = count(i);
    std::uint64_t hash = 1469598103934665603u;
    for (std::uint32_t m = 0; m < n; ++m) hash = (hash ^ (neighbours(i)[m] - i)) * 1099511628211u;
    double* here = forward_.data() + start_[i] * stride_;
    double largest = 0;
    for (std::size_t k = 0; k < n * stride_; ++k) largest = std::max(largest, std::fabs(here[k]));
    const auto is_same = [&](std::uint64_t other) {
      if (count(other) != n) return false;
      for (std::uint32_t m = 0; m < n; ++m)
        if (neighbours(other)[m] - other != neighbours(i)[m] - i) return false;
      const double* there = forward(other);
      for (std::size_t k = 0; k < n * stride_; ++k)
        if (!(std::fabs(here[k] - there[k]) <= same_weight * largest)) return false;
      return true;
    };
    std::vector<std::uint64_t>& candidates = known[hash];
    const auto found = std::find_if(candidates.begin(), candidates.end(), is_same);
    if (found != candidates.end())
      std::copy_n(forward(*found), n * stride_, here);
    else if (candidates.size() < most_candidates)
      candidates.push_back(i);
  }
}

void ReferenceRows::backward(std::uint64_t i, const double* volume, std::vector<double>& out) const {
  out.assign(count(i) * stride_, 0.0);
  for (std::uint32_t m = 0; m < count(i); ++m) {
    const std::uint64_t j = neighbours(i)[m];
    const std::uint32_t* end = neighbours(j) + count(j);
    const std::uint32_t* place = std::lower_bound(neighbours(j), end, static_cast<std::uint32_t>(i));
    if (place == end || *place != i) continue;
    const double* there = forward(j) + static_cast<std::size_t>(place - neighbours(j)) * stride_;
    for (std::size_t k = 0; k < stride_; ++k) out[m * stride_ + k] = volume[j] / volume[i] * there[k];
  }
}

}  // namespace shoal::solid
