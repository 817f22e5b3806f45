// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "force_consistency.hpp"

#include <algorithm>
#include <cmath>

#include "monomials.hpp"
#include "reference_weights.hpp"
#include "shoal/smoothing_kernel.hpp"

namespace shoal::solid {
namespace {

constexpr double goal = 1e-3;  // of the residual, times the spacing
// What is left beyond is of long wave length, and the smoother the less it does.
constexpr int most_iterations = 200;

// On a lattice: neighbours of a held surface and their neighbours. What its moments keep of the residual is then left,
// in equilibrium with itself, five spacings inside; more rings move it further in and change nothing else.
constexpr int rings = 2;

template <int D>
using Vectors = std::vector<Vec<D>>;

template <int D>
double inner(const Vectors<D>& a, const Vectors<D>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += dot(a[i], b[i]);
  return sum;
}

// The symmetric system of the multipliers.
template <int D>
class MultiplierSystem {
 public:
  static constexpr int N = n_monomials<D>;
  using Fit = Eigen::Matrix<double, N, D>;

  MultiplierSystem(const ReferenceSettings& settings, const shoal_neighbours& list,
                   const ReferenceGeometry& geometry)
      : settings_(settings),
        list_(list),
        geometry_(geometry),
        kernel_(settings.smoothing_length),
        n_(list.n_rows) {
    factors_.reserve(n_);
    fits_.resize(n_);
    for (std::uint64_t i = 0; i < n_; ++i) {
      factors_.emplace_back(moments(i));
      fits_well_.push_back(!holds(i) && well_conditioned<D>(factors_.back()));
    }
    near_held_.assign(n_, 0);
    if (geometry.held != nullptr)
      for (std::uint64_t i = 0; i < n_; ++i)
        near_held_[i] = holds(i) || any_neighbour(i, [&](std::uint32_t j) { return holds(j); });
    find_constraints();
  }

  // Whether all particles with all of their neighbours see them evenly, as on a lattice: then forces are consistent but
  // for two supports' depth under the surface, where the change would do no good.
  bool is_lattice() const {
    for (std::uint64_t i = 0; i < n_; ++i) {
      if (kind_[i] != Kind::inside || near_held(i)) continue;
      Vec<D> sum{};
      double scale = 0;
      const Row row = row_of(list_, i);
      for (std::uint32_t m = 0; m < row.n; ++m) {
        const Vec<D> d = difference(i, row.j[m]);
        const double w = kernel_.w(norm(d) * settings_.smoothing_length);
        sum += w * d;
        scale += w * norm(d);
      }
      if (norm(sum) > 1e-9 * scale) return false;
    }
    return true;
  }

  // Leaves no more to constrain than what is near a held surface, and says how many particles that are.
  std::uint64_t constrain_near_held() {
    std::vector<std::uint8_t> reached = near_held_;
    for (int ring = 1; ring < rings; ++ring) {
      const std::vector<std::uint8_t> inner = reached;
      for (std::uint64_t i = 0; i < n_; ++i)
        if (inner[i] == 0) reached[i] = any_neighbour(i, [&](std::uint32_t j) { return inner[j] != 0; });
    }
    std::uint64_t count = 0;
    for (std::uint64_t i = 0; i < n_; ++i) {
      if (reached[i] == 0) kind_[i] = Kind::free;
      count += kind_[i] != Kind::free;
    }
    return count;
  }

  // Removes the part of vectors that is not constrained.
  void constrain(Vectors<D>& a) const {
    for (std::uint64_t i = 0; i < n_; ++i) {
      if (kind_[i] == Kind::free) a[i] = Vec<D>{};
      if (kind_[i] == Kind::surface) a[i] -= dot(a[i], normal(i)) * normal(i);
    }
  }

  // sum_j [V_j w_ji res_ji - V_i w_ij res_ij], positive semi-definite; constrained.
  void apply(const Vectors<D>& l, Vectors<D>& out) {
    for (std::uint64_t i = 0; i < n_; ++i) fits_[i] = fit(i, l);
    for (std::uint64_t i = 0; i < n_; ++i) {
      Vec<D> sum{};
      const Row row = row_of(list_, i);
      for (std::uint32_t m = 0; m < row.n; ++m) {
        const std::uint64_t j = row.j[m];
        const Vec<D> d = difference(i, j);
        const double w = volume(i) * weight(j, d);
        sum += w * (residual(j, i, -d, l) - residual(i, j, d, l));
      }
      out[i] = sum;
    }
    constrain(out);
  }

  // Adds w_ij res_ij of the multipliers to the gradients.
  void change(const Vectors<D>& l, const std::vector<std::uint64_t>& offsets, double* forward) {
    for (std::uint64_t i = 0; i < n_; ++i) {
      if (holds(i)) continue;
      fits_[i] = fit(i, l);
      const Row row = row_of(list_, i);
      for (std::uint32_t m = 0; m < row.n; ++m) {
        const Vec<D> d = difference(i, row.j[m]);
        const Vec<D> change = weight(row.j[m], d) * residual(i, row.j[m], d, l);
        double* g = forward + (offsets[i] + m) * (D + 1);
        for (int a = 0; a < D; ++a) g[a] += change[a];
      }
    }
  }

 private:
  enum class Kind : std::uint8_t { inside, surface, free };

  double volume(std::uint64_t i) const { return geometry_.volume[i]; }
  Vec<D> normal(std::uint64_t i) const {
    Vec<D> n;
    for (int a = 0; a < D; ++a) n[a] = geometry_.normal[i * D + static_cast<std::uint64_t>(a)];
    return n;
  }
  // (X_j - X_i) / h, held particles in their places at the surface.
  Vec<D> difference(std::uint64_t i, std::uint64_t j) const {
    Vec<D> d;
    for (int a = 0; a < D; ++a) {
      const auto k = static_cast<std::uint64_t>(a);
      d[a] = geometry_.position[j * D + k] - geometry_.position[i * D + k];
      if (holds(j)) d[a] -= geometry_.held->shift[j * D + k];
      d[a] /= settings_.smoothing_length;
    }
    return d;
  }
  double weight(std::uint64_t j, const Vec<D>& d) const {
    if (holds(j) && !geometry_.held->shows(j)) return 0.0;
    return volume(j) * kernel_.w(norm(d) * settings_.smoothing_length);
  }

  bool near_held(std::uint64_t i) const { return near_held_[i] != 0; }
  bool holds(std::uint64_t i) const { return geometry_.held != nullptr && geometry_.held->holds(i); }
  template <class Condition>
  bool any_neighbour(std::uint64_t i, const Condition& condition) const {
    const Row row = row_of(list_, i);
    return std::any_of(row.j, row.j + row.n, condition);
  }
  Moments<D> moments(std::uint64_t i) const {
    Moments<D> sum = Moments<D>::Zero();
    const Row row = row_of(list_, i);
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const Vec<D> d = difference(i, row.j[m]);
      const Monomials<D> p = monomials<D>(d);
      sum.noalias() += weight(row.j[m], d) * p * p.transpose();
    }
    return sum;
  }
  Fit fit(std::uint64_t i, const Vectors<D>& l) const {
    Fit sum = Fit::Zero();
    const Row row = row_of(list_, i);
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const Vec<D> d = difference(i, row.j[m]);
      const Monomials<D> p = weight(row.j[m], d) * monomials<D>(d);
      for (int a = 0; a < D; ++a) sum.col(a) += (l[row.j[m]][a] - l[i][a]) * p;
    }
    return fits_well_[i] ? Fit(factors_[i].solve(sum)) : Fit(Fit::Zero());
  }
  // What of the multipliers' difference the fit at i leaves; rows of too few neighbours are not changed.
  Vec<D> residual(std::uint64_t i, std::uint64_t j, const Vec<D>& d, const Vectors<D>& l) const {
    if (!fits_well_[i]) return {};
    const Monomials<D> p = monomials<D>(d);
    Vec<D> r = l[j] - l[i];
    for (int a = 0; a < D; ++a) r[a] -= fits_[i].col(a).dot(p);
    return r;
  }

  void find_constraints() {
    const double reach = 2.0 * settings_.smoothing_length;
    kind_.assign(n_, Kind::inside);
    for (std::uint64_t i = 0; i < n_; ++i) {
      if (holds(i)) {
        kind_[i] = Kind::free;
        continue;
      }
      if (geometry_.distance[i] < -reach) continue;
      kind_[i] = Kind::surface;
      // Near an edge no direction is tangential.
      const Row row = row_of(list_, i);
      for (std::uint32_t m = 0; m < row.n; ++m)
        if (geometry_.distance[row.j[m]] > -reach && dot(normal(i), normal(row.j[m])) < 0.9)
          kind_[i] = Kind::free;
    }
  }

  const ReferenceSettings& settings_;
  const shoal_neighbours& list_;
  const ReferenceGeometry& geometry_;
  WendlandC2<D> kernel_;
  std::uint64_t n_;
  std::vector<Eigen::LLT<Moments<D>>> factors_;
  std::vector<bool> fits_well_;
  std::vector<Fit> fits_;
  std::vector<Kind> kind_;
  std::vector<std::uint8_t> near_held_;
};

}  // namespace

template <int D>
ForceConsistency make_consistent(const ReferenceSettings& settings, const shoal_neighbours& list,
                                 const ReferenceGeometry& geometry, const std::vector<std::uint64_t>& offsets,
                                 double* forward) {
  const std::uint64_t n = list.n_rows;
  // V_i r_i; every pair gives to both of its particles.
  Vectors<D> r(n);
  for (std::uint64_t i = 0; i < n; ++i) {
    const Row row = row_of(list, i);
    for (std::uint32_t m = 0; m < row.n; ++m)
      for (int a = 0; a < D; ++a) {
        const double g =
            geometry.volume[i] * forward[(offsets[i] + m) * (D + 1) + static_cast<std::size_t>(a)];
        r[i][a] += g;
        r[row.j[m]][a] -= g;
      }
  }
  MultiplierSystem<D> system(settings, list, geometry);
  std::uint64_t n_constrained = n;
  if (system.is_lattice()) {
    if (geometry.held == nullptr) return {};
    n_constrained = std::max<std::uint64_t>(1, system.constrain_near_held());
  }
  system.constrain(r);
  const double unit =
      settings.spacing / std::pow(settings.spacing, D) / std::sqrt(static_cast<double>(n_constrained));
  ForceConsistency report;
  double square = inner<D>(r, r);
  report.before = report.after = unit * std::sqrt(square);
  if (report.before < goal) return report;
  Vectors<D> l(n), direction = r, image(n);
  for (; report.iterations < most_iterations && report.after > goal; ++report.iterations) {
    system.apply(direction, image);
    const double step = square / inner<D>(direction, image);
    for (std::uint64_t i = 0; i < n; ++i) {
      l[i] += step * direction[i];
      r[i] -= step * image[i];
    }
    const double next = inner<D>(r, r);
    for (std::uint64_t i = 0; i < n; ++i) direction[i] = r[i] + (next / square) * direction[i];
    square = next;
    report.after = unit * std::sqrt(square);
  }
  system.change(l, offsets, forward);
  return report;
}

template ForceConsistency make_consistent<2>(const ReferenceSettings&, const shoal_neighbours&,
                                             const ReferenceGeometry&, const std::vector<std::uint64_t>&,
                                             double*);
template ForceConsistency make_consistent<3>(const ReferenceSettings&, const shoal_neighbours&,
                                             const ReferenceGeometry&, const std::vector<std::uint64_t>&,
                                             double*);

}  // namespace shoal::solid
