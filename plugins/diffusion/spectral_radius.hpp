// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The largest magnitude of an eigenvalue of a discrete operator, without storing more than three vectors:
//   1  power iterations from fixed random numbers: a first estimate, low, since the highest modes lie close together, or
//      are few among disordered particles
//   2  Chebyshev polynomials of the operator that stay small for eigenvalues up to 0.8 of that estimate and grow fast
//      beyond: of degree 16 they leave the highest modes alone
//   3  power iterations for their eigenvalue; then 2 and 3 again, up to 0.9 of it, until it rises by less than 1 %
// The result is a lower bound for a symmetric operator, a few parts in a thousand low; `spectral_margin` covers that and
// the asymmetry of the fit on disordered particles. Compared with dense matrices by
// tests/plugins/diffusion/spectral_radius_test.cpp; plain power iterations needed a margin of 10 %.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "stencil.hpp"

namespace shoal::diffusion {

inline constexpr double spectral_margin = 1.04;

// The rows of a stencil as a matrix. Neighbours in images and other bodies are taken to be at zero: the eigenvectors
// that matter alternate from particle to particle and do not care.
template <class Op>
class StencilMatrix {
 public:
  StencilMatrix(const Op& op, const Stencil& stencil, bool with_more)
      : list_(op.neighbours(0)),
        weights_(stencil.weights[0].data()),
        more_(with_more ? stencil.more[0].data() : nullptr),
        diagonal_(op.n_particles()),
        size_(diagonal_.size()) {
    for (std::size_t k = 0; k < op.n_relations(); ++k)
      for (std::size_t i = 0; i < diagonal_.size(); ++i)
        for (std::uint32_t m = 0; m < op.neighbours(k).counts[i]; ++m) {
          const std::uint64_t entry = op.neighbours(k).offsets[i] + m;
          diagonal_[i] += stencil.weights[k][entry] + (with_more ? stencil.more[k][entry] : 0.0);
          if (k == 0) size_ = std::max<std::size_t>(size_, list_.indices[entry] + 1);
        }
    for (const auto& chunk : stencil.surface)
      for (const SurfaceWeight& w : chunk)
        diagonal_[w.i] += w.per_value + (with_more ? w.more_per_value : 0.0);
  }
  // Of vectors: the images come last, and stay zero.
  std::size_t size() const { return size_; }
  std::size_t rows() const { return diagonal_.size(); }
  // y = -L c, whose large eigenvalues are positive
  void apply(const std::vector<double>& c, std::vector<double>& y) const {
    for (std::size_t i = 0; i < rows(); ++i) {
      const std::uint32_t* row = list_.indices + list_.offsets[i];
      const double* weight = weights_ + list_.offsets[i];
      Pack sum(0.0);
      for (std::uint32_t m = 0; m < list_.counts[i]; m += lanes) {
        const Pack l = more_ == nullptr ? Pack::load(weight + m)
                                        : Pack::load(weight + m) + Pack::load(more_ + list_.offsets[i] + m);
        sum += l * gather<1, 0>(c.data(), IndexPack::load(row + m));
      }
      y[i] = diagonal_[i] * c[i] - horizontal_sum(sum);
    }
  }

 private:
  const shoal_neighbours& list_;
  const double* weights_;
  const double* more_;  // or null
  std::vector<double> diagonal_;
  std::size_t size_;
};

namespace impl {

inline double norm_of(const std::vector<double>& c) {
  double sum = 0;
  for (const double value : c) sum += value * value;
  return std::sqrt(sum);
}

// Largest growth in n power iterations but the first: in single ones it varies where eigenvalues are complex. c keeps
// the norm 1. 0 if nothing is left of it.
template <class Matrix>
double power_iterations(const Matrix& matrix, int n, std::vector<double>& c, std::vector<double>& next) {
  double radius = 0;
  for (int iteration = 0; iteration < n; ++iteration) {
    matrix.apply(c, next);
    const double growth = norm_of(next);
    if (!(growth > 0.0)) return 0.0;
    if (iteration > 0) radius = std::max(radius, growth);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = next[i] / growth;
  }
  return radius;
}

// c becomes T_degree(2 A / bound - 1) c over its norm.
template <class Matrix>
void chebyshev(const Matrix& matrix, double bound, int degree, std::vector<double>& c,
               std::vector<double>& next) {
  std::vector<double> before = c;
  const double f = 2.0 / bound;
  matrix.apply(before, next);
  for (std::size_t i = 0; i < c.size(); ++i) c[i] = f * next[i] - before[i];
  for (int k = 2; k <= degree; ++k) {
    matrix.apply(c, next);
    const double scale = 1.0 / norm_of(c);  // keeps both from growing beyond all bounds
    for (std::size_t i = 0; i < c.size(); ++i) {
      const double newest = scale * (2.0 * (f * next[i] - c[i]) - before[i]);
      before[i] = scale * c[i];
      c[i] = newest;
    }
  }
  const double scale = 1.0 / norm_of(c);
  for (double& value : c) value *= scale;
}

}  // namespace impl

// In 1/s. Serial, costs as much as 48 to 136 evaluations of the rate; done once for bodies at rest.
template <class Matrix>
double spectral_radius(const Matrix& matrix) {
  std::vector<double> c(matrix.size()), next(matrix.size());
  std::uint64_t random = 0x9e3779b97f4a7c15u;
  for (std::size_t i = 0; i < matrix.rows(); ++i) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    c[i] = static_cast<double>(random >> 11) / 9007199254740992.0 - 0.5;
  }
  double radius = impl::power_iterations(matrix, 4, c, next);
  double last = 0;
  for (int round = 0; round < 6 && radius > 1.01 * last; ++round) {
    last = round == 0 ? 0.0 : radius;
    impl::chebyshev(matrix, (round == 0 ? 0.8 : 0.9) * radius, 16, c, next);
    radius = std::max(last, impl::power_iterations(matrix, 6, c, next));
  }
  return radius;
}

}  // namespace shoal::diffusion
