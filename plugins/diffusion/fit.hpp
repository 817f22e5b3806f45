// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The accurate scheme: second derivatives from a quadratic weighted least-squares fit, with what is known of the surface
// among the rows that are fitted.
//   c(x) - c_i = a . p(x - x_i),   p = (x, y, xx, xy, yy) or (x, y, z, xx, xy, xz, yy, yz, zz), lengths over h
//   rows   c_j - c_i = a . p(x_j - x_i)                                  for each neighbour j
//          A c + B n . K grad c = g at the surface point of a particle    for each such point b (surface.hpp)
//   each weighted with W(r). Then, with the second derivatives d2 that follow from a and K_ij = (K_i + K_j) / 2,
//   C dc_i/dt = sum_j K_ij : d2_ij (c_j - c_i) + sum_b K_ib : d2_ib (g_b - A_b c_i),
// which is div(K grad c), as d_a (K d_b c) = (d_a d_b (K c) - c d_a d_b K + K d_a d_b c) / 2.
// Neighbours in another body are seen across the interface (cross_interface).
// Second order inside, at surfaces of any shape, and on disordered particles; a surface of which nothing is said is
// insulated by A = 0, B = 1, g = 0. Contents are kept to second order, not to rounding. K has to be smooth.
// Where neighbours are too few for the fit, the row is that of the conservative scheme.
// Measured for the Laplacian on 20 x 20 particles disordered by 0.2 dx, squares and discs, surfaces of value or flux: all
// eigenvalues have a negative real part.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "monotone.hpp"
#include "pairwise.hpp"
#include "small_matrix.hpp"
#include "stencil.hpp"

namespace shoal::diffusion {

template <int D>
struct Quadratic {
  static constexpr int terms = D == 2 ? 5 : 9;
  using Terms = SmallVector<terms>;

  // p at the distance x / h
  static Terms monomials(const Vec<D>& x) {
    Terms p{};
    std::size_t k = 0;
    for (int a = 0; a < D; ++a) p[k++] = x[a];
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) p[k++] = x[a] * x[b];
    return p;
  }
  // (v . grad) p there
  static Terms derivative(const Vec<D>& x, const Vec<D>& v) {
    Terms p{};
    std::size_t k = 0;
    for (int a = 0; a < D; ++a) p[k++] = v[a];
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) p[k++] = v[a] * x[b] + x[a] * v[b];
    return p;
  }
  // Coefficients on a of K : d2
  static Terms contraction(const SmallMatrix<terms>& inverse, const Mat<D>& k, double h) {
    Terms g{};
    int row = D;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b, ++row)
        for (int c = 0; c < terms; ++c)
          g[static_cast<std::size_t>(c)] += 2.0 / (h * h) * k(a, b) * inverse(row, c);
    return g;
  }
  // The same of a when it is multiplied with it: K : d2 c + (div K) . grad c
  static Terms target(const Mat<D>& k, const Vec<D>& divergence, double h) {
    Terms g{};
    std::size_t row = 0;
    for (int a = 0; a < D; ++a) g[row++] = divergence[a] / h;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) g[row++] = 2.0 / (h * h) * k(a, b);
    return g;
  }
  static double dot(const Terms& a, const Terms& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
  }
};

// Computes the weights of pairs and of surface points where particles have moved since the last time.
class FitWeights : public WeightsOfPairs {
 public:
  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if (!active()) return;
    auto& surface = stencil->surface_of(chunk);
    with_kernel<D>(target().smoothing_kernel, smoothing_length(), [&](const auto& kernel) {
      const LatticeMoments<D> lattice(kernel, spacing());
      std::vector<Row<D>> rows;
      for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
        gather_rows<D>(kernel, i, rows);
        double sum = !monotone          ? fit_row<D>(i, rows, surface)
                     : stencil->limited ? limited_row<D>(i, rows, surface)
                                        : monotone_row<D>(i, rows, surface);
        if (sum < 0.0) sum = pairwise_row<D>(kernel, lattice, i, surface);
        row_sum.update(Particle<D>{i, chunk.partial}, sum);
      }
    });
  }
  template <int D>
  void run_chunk_scalar(const shoal_chunk& chunk) const {
    run_chunk<D>(chunk);
  }

  bool monotone = false;

 private:
  template <int D>
  struct Row {
    typename Quadratic<D>::Terms p;  // divided by `size`
    double weight;
    double size;
    int relation;  // -1: the particle itself
    std::uint32_t j;
    std::uint64_t entry;   // in the list, of a neighbour
    int condition;         // number of the condition at a surface point; 0: a neighbour
    bool foreign = false;  // a neighbour across an interface, seen by the polynomial of this side
  };

  template <int D, class Kernel>
  void gather_rows(const Kernel& kernel, std::uint64_t i, std::vector<Row<D>>& rows) const {
    rows.clear();
    std::vector<InterfacePoint<D>> interface;
    gather_interface<D>(i, interface);
    const Vec<D> x_i = position[Particle<D>{i, nullptr}];
    const double per_h = 1.0 / smoothing_length();
    if (points) add_surface_point<D>(kernel, x_i, -1, static_cast<std::uint32_t>(i), rows);
    for (std::size_t k = 0; k < n_relations(); ++k) {
      const shoal_neighbours& list = neighbours(k);
      for (std::uint64_t entry = list.offsets[i]; entry < list.offsets[i] + list.counts[i]; ++entry) {
        const std::uint32_t j = list.indices[entry];
        Vec<D> x = gather_vec<D>(position.of_neighbours(k), j) - x_i;
        if (k >= first_wall) {  // the value of a wall holds at its surface
          const auto point = points->template at<D>(*this, static_cast<int>(k), j);
          if (point.number == 0) continue;
          x = point.place - x_i;
        }
        const double w = kernel.w(norm(x));
        if (w > 0.0)
          rows.push_back({Quadratic<D>::monomials(per_h * x), w, 1.0, static_cast<int>(k), j, entry, 0});
        if (w > 0.0 && points && k > 0 && k < first_wall) cross_interface<D>(i, x, interface, rows.back());
        if (points && k == 0) add_surface_point<D>(kernel, x_i, 0, j, rows);
      }
    }
  }

  // A point of an interface to another body, from particle i, and the normal out of i's body.
  template <int D>
  struct InterfacePoint {
    Vec<D> place, normal;
  };

  template <int D>
  void gather_interface(std::uint64_t i, std::vector<InterfacePoint<D>>& interface) const {
    interface.clear();
    if (!points || std::min(n_relations(), first_wall) < 2) return;
    const Vec<D> x_i = position[Particle<D>{i, nullptr}];
    const auto add = [&](int relation, std::uint32_t j) {
      const auto point = points->template at<D>(*this, relation, j);
      if (point.number != SurfacePoints::interface) return;
      interface.push_back({point.place - x_i, (relation > 0 ? -1.0 : 1.0) * point.normal});
    };
    add(-1, static_cast<std::uint32_t>(i));
    for (std::size_t k = 0; k < std::min(n_relations(), first_wall); ++k)
      for (std::uint32_t m = 0; m < neighbours(k).counts[i]; ++m)
        add(static_cast<int>(k), neighbours(k).indices[neighbours(k).offsets[i] + m]);
  }

  // Neighbour j at x from particle i is in another body. With n across the interface, from here to there, the point x' at
  // the interface on the way to j and s its distance to j, c_j follows from the polynomial on this side:
  //   c_j = c(x') + s (k / k_j) dc/dn + s^2 / 2 (c_nn of there),   c_nn = (a / a_j - 1) lap c + c_nn of here
  // since c, K n . grad c and dc/dt are continuous; k = n . K n, a = k / capacity.
  template <int D>
  void cross_interface(std::uint64_t i, const Vec<D>& x, const std::vector<InterfacePoint<D>>& interface,
                       Row<D>& row) const {
    const auto k = static_cast<std::size_t>(row.relation);
    const auto distance = [&](const InterfacePoint<D>& b) { return squared_norm(b.place - 0.5 * x); };
    const auto nearest =
        std::min_element(interface.begin(), interface.end(),
                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (nearest == interface.end()) return;
    const Vec<D> n = nearest->normal;
    const double s = std::clamp(dot(n, x - nearest->place), 0.0, norm(x));
    const double k_i = dot(n, own_tensor<D>(i) * n), k_j = dot(n, tensor_of<D>(k, row.j) * n);
    const double ratio = k_i / k_j;
    // Where the other side is much slower, its curvature does not follow from this one: it is taken as steady.
    double diffusivities = ratio * capacities[k] / capacity;
    if (diffusivities > 4.0) diffusivities = 0.0;
    const double per_h = 1.0 / smoothing_length();
    const Vec<D> at = per_h * (x - s * n);
    const double depth = per_h * s;
    const auto value = Quadratic<D>::monomials(at), slope = Quadratic<D>::derivative(at, n);
    row.size = std::max(1.0, ratio);
    for (std::size_t t = 0; t < row.p.size(); ++t) row.p[t] = value[t] + depth * ratio * slope[t];
    std::size_t t = D;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b, ++t) {
        const double laplacian = a == b ? 2.0 : 0.0, along_n = (a == b ? 1.0 : 2.0) * 2.0 * n[a] * n[b];
        row.p[t] += 0.5 * depth * depth * ((diffusivities - 1.0) * laplacian + along_n);
      }
    for (double& term : row.p) term /= row.size;
    row.foreign = true;
  }

  // The row of the surface point that particle j carries, if it has one within reach.
  template <int D, class Kernel>
  void add_surface_point(const Kernel& kernel, const Vec<D>& x_i, int relation, std::uint32_t j,
                         std::vector<Row<D>>& rows) const {
    const auto point = points->template at<D>(*this, relation, j);
    if (point.number < 1) return;
    const double per_h = 1.0 / smoothing_length();
    const Vec<D> x = point.place - x_i;
    const double w = kernel.w(norm(x));
    if (!(w > 0.0)) return;
    const Condition condition =
        point.number == 1 ? Condition{} : points->conditions[static_cast<std::size_t>(point.number - 2)];
    const Mat<D> k = relation < 0 ? own_tensor<D>(j) : tensor_of<D>(0, j);
    const Vec<D> flux = condition.b * per_h * (k * point.normal);
    auto p = Quadratic<D>::derivative(per_h * x, flux);
    const auto value = Quadratic<D>::monomials(per_h * x);
    // The row is divided by its size, so that it weighs as much as those of neighbours.
    const double size = std::abs(condition.a) + norm(flux);
    for (std::size_t t = 0; t < p.size(); ++t) p[t] = (p[t] + condition.a * value[t]) / size;
    rows.push_back({p, w, size, relation, j, 0, point.number});
  }

  // Fills the weights of row i; returns sum |l|, or a negative number if the rows do not determine the fit.
  template <int D>
  double fit_row(std::uint64_t i, const std::vector<Row<D>>& rows,
                 std::vector<SurfaceWeight>& surface) const {
    constexpr int terms = Quadratic<D>::terms;
    if (rows.size() < static_cast<std::size_t>(terms + 1)) return -1.0;
    SmallMatrix<terms> moments;
    for (const Row<D>& row : rows)
      for (int a = 0; a < terms; ++a)
        for (int b = 0; b <= a; ++b)
          moments(a, b) +=
              row.weight * row.p[static_cast<std::size_t>(a)] * row.p[static_cast<std::size_t>(b)];
    for (int a = 0; a < terms; ++a)
      for (int b = 0; b < a; ++b) moments(b, a) = moments(a, b);
    if (invert(moments) < 1e-8) return -1.0;

    const Mat<D> k_i = own_tensor<D>(i);
    const double h = smoothing_length();
    auto g = Quadratic<D>::contraction(moments, k_i, h);
    Mat<D> k_of_g = k_i;
    double total = 0;
    for (const Row<D>& row : rows) {
      const Mat<D> k_j = row.relation < 0 ? own_tensor<D>(row.j)
                                          : tensor_of<D>(static_cast<std::size_t>(row.relation), row.j);
      const Mat<D> mean = row.foreign ? k_i : 0.5 * (k_i + k_j);
      if (!(mean == k_of_g)) {
        g = Quadratic<D>::contraction(moments, mean, h);
        k_of_g = mean;
      }
      const double l = row.weight / capacity * Quadratic<D>::dot(g, row.p);
      total += row.condition == 0 ? fill_pair<D>(row, l) : fill_surface<D>(i, row, l, surface);
    }
    return total;
  }
  // The row of the monotone scheme (monotone.hpp).
  template <int D>
  double monotone_row(std::uint64_t i, const std::vector<Row<D>>& rows,
                      std::vector<SurfaceWeight>& surface) const {
    using Q = Quadratic<D>;
    std::vector<MonotoneRow<Q::terms>> plain;
    for (const Row<D>& row : rows) {
      const bool data_alone =
          row.condition == 1 ||
          (row.condition > 1 && points->conditions[static_cast<std::size_t>(row.condition - 2)].a == 0.0);
      plain.push_back({row.p, row.weight, !data_alone});
    }
    const auto multipliers = monotone_multipliers<D, Q::terms>(
        plain, Q::target(own_tensor<D>(i), divergence<D>(i), smoothing_length()));
    double total = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double along = Q::dot(multipliers, rows[r].p);
      const double l = plain[r].weight / capacity * (plain[r].bounded ? std::max(0.0, along) : along);
      total += rows[r].condition == 0 ? fill_pair<D>(rows[r], l) : fill_surface<D>(i, rows[r], l, surface);
    }
    return total;
  }

  // The row of the monotone scheme, and what that of the fit has more; returns the larger sum |l| of the two.
  template <int D>
  double limited_row(std::uint64_t i, const std::vector<Row<D>>& rows,
                     std::vector<SurfaceWeight>& surface) const {
    const auto at = [&](auto& of_pairs, const Row<D>& row) -> double& {
      return of_pairs[static_cast<std::size_t>(row.relation)][row.entry];
    };
    std::vector<SurfaceWeight> accurate;
    const double of_fit = fit_row<D>(i, rows, accurate);
    for (const Row<D>& row : rows)
      if (of_fit >= 0.0 && row.condition == 0) at(stencil->more, row) = at(stencil->weights, row);
    const std::size_t first = surface.size();
    const double total = monotone_row<D>(i, rows, surface);
    if (of_fit < 0.0) return total;
    for (const Row<D>& row : rows)
      if (row.condition == 0) at(stencil->more, row) -= at(stencil->weights, row);
    for (std::size_t k = 0; k < accurate.size(); ++k) {  // both have an entry for each row, in their order
      surface[first + k].more_per_data = accurate[k].per_data - surface[first + k].per_data;
      surface[first + k].more_per_value = accurate[k].per_value - surface[first + k].per_value;
    }
    return std::max(total, of_fit);
  }

  // div K at particle i, from a linear fit of K over the neighbours in its body.
  template <int D>
  Vec<D> divergence(std::uint64_t i) const {
    const Mat<D> k_i = own_tensor<D>(i);
    const Vec<D> x_i = position[Particle<D>{i, nullptr}];
    SmallMatrix<D> moments;
    Mat<D> sums[D] = {};  // of x_c (K_j - K_i)
    bool varies = false;
    for (std::uint32_t m = 0; m < neighbours(0).counts[i]; ++m) {
      const std::uint32_t j = neighbours(0).indices[neighbours(0).offsets[i] + m];
      const Vec<D> x = gather_vec<D>(position.of_neighbours(0), j) - x_i;
      const Mat<D> more = tensor_of<D>(0, j) - k_i;
      varies = varies || !(more == Mat<D>{});
      for (int c = 0; c < D; ++c) {
        sums[c] += x[c] * more;
        for (int b = 0; b < D; ++b) moments(c, b) += x[c] * x[b];
      }
    }
    Vec<D> result{};
    if (!varies || invert(moments) < 1e-8) return result;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        for (int c = 0; c < D; ++c) result[a] += moments(b, c) * sums[c](a, b);
    return result;
  }

  template <int D>
  double fill_pair(const Row<D>& row, double l) const {
    stencil->weights[static_cast<std::size_t>(row.relation)][row.entry] = l / row.size;
    return std::abs(l) / row.size;
  }
  template <int D>
  double fill_surface(std::uint64_t i, const Row<D>& row, double l,
                      std::vector<SurfaceWeight>& surface) const {
    if (row.condition < 2) return 0.0;
    const double per_data = l / row.size;
    const double per_value = per_data * points->conditions[static_cast<std::size_t>(row.condition - 2)].a;
    surface.push_back({static_cast<std::uint32_t>(i), row.j, row.relation, per_data, per_value, 0.0, 0.0});
    return std::abs(per_value);
  }
};

}  // namespace shoal::diffusion
