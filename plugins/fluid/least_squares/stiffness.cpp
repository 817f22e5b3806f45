// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fit.hpp"

namespace shoal::fluid::least_squares {
namespace {

constexpr double margin = 1.3;

template <int D>
struct LatticeLaplacian {
  std::vector<Vec<D>> x;  // of neighbours, in dx
  std::vector<double> l;  // times dx^2
  double norm_bound = 0;  // on sum |l|

  explicit LatticeLaplacian(double h) {
    const Weight<D> kernel(h);
    constexpr int N = fit_terms<D>;
    Vec<fit::moments<D>> m{};
    const int n = static_cast<int>(kernel.cutoff());
    const int depth = D == 3 ? n : 0;
    for (int a = -n; a <= n; ++a)
      for (int b = -n; b <= n; ++b)
        for (int c = -depth; c <= depth; ++c) {
          Vec<D> d;
          d[0] = a, d[1] = b;
          if constexpr (D == 3) d[2] = c;
          if ((a == 0 && b == 0 && c == 0) || norm(d) >= kernel.cutoff()) continue;
          x.push_back(d);
          const auto q = fit_monomials((1.0 / h) * d);
          for (int r = 0, k = 0; r < N; ++r)
            for (int s = r; s < N; ++s) m[k++] += kernel.w(norm(d)) * q[r] * q[s];
        }
    typename impl::Element<FitLaplacian, D>::type row;
    fit::keep<FitLaplacian, D>(fit::derivatives<D>(m, h, 0.0), row);
    double weights = 0;
    for (const Vec<D>& d : x) weights += kernel.w(norm(d));
    norm_bound = least_squares::laplacian_norm<D>(weights, row, h);
    for (const Vec<D>& d : x) {
      const auto q = fit_monomials((1.0 / h) * d);
      double weight = 0;
      for (int r = 0; r < N; ++r) weight += row[static_cast<std::size_t>(r)] * q[r];
      l.push_back(kernel.w(norm(d)) * weight);
    }
  }

  double eigenvalue(const Vec<D>& k) const {
    double sum = 0;
    for (std::size_t j = 0; j < x.size(); ++j) sum += l[j] * (1.0 - std::cos(dot(k, x[j])));
    return sum;
  }
};

template <int D>
double largest_eigenvalue(double h) {
  const LatticeLaplacian<D> lattice(h);
  constexpr int n = 8;
  double largest = 0;
  for (int a = 0; a <= n; ++a)
    for (int b = 0; b <= n; ++b)
      for (int c = 0; c <= (D == 3 ? n : 0); ++c) {
        Vec<D> k;
        k[0] = a, k[1] = b;
        if constexpr (D == 3) k[2] = c;
        largest = std::max(largest, lattice.eigenvalue((std::numbers::pi / n) * k));
      }
  return largest;
}

}  // namespace

double laplacian_stiffness(int dimensions, double h_over_dx) {
  return margin * (dimensions == 2 ? largest_eigenvalue<2>(h_over_dx) : largest_eigenvalue<3>(h_over_dx));
}

double eigenvalue_over_norm(int dimensions, double h_over_dx) {
  return dimensions == 2 ? largest_eigenvalue<2>(h_over_dx) / LatticeLaplacian<2>(h_over_dx).norm_bound
                         : largest_eigenvalue<3>(h_over_dx) / LatticeLaplacian<3>(h_over_dx).norm_bound;
}

}  // namespace shoal::fluid::least_squares
