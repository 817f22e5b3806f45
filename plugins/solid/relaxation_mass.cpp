// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "relaxation_mass.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "shoal/host.hpp"

namespace shoal::solid {
namespace {

constexpr double reach = 1.6;       // of bonds, in spacings
constexpr double across = 1e-6;     // stiffness of a bond across its line over that along it
constexpr double to_ground = 1e-9;  // of a particle, over that of a bond

}  // namespace

void RelaxationMass::connect(int dimensions, const shoal_neighbours& list, const double* X, double spacing,
                             double shear_modulus) {
  dimensions_ = static_cast<std::size_t>(dimensions);
  n_ = list.n_rows;
  const double unit = unit_ = shear_modulus * std::pow(spacing, dimensions - 2);
  bonds_.clear();
  for (std::uint64_t i = 0; i < n_; ++i) {
    const Row row = row_of(list, i);
    for (std::uint32_t m = 0; m < row.n; ++m) {
      const std::uint32_t j = row.j[m];
      if (j <= i || j >= n_) continue;
      double square = 0;
      for (std::size_t a = 0; a < dimensions_; ++a)
        square += std::pow(X[j * dimensions_ + a] - X[i * dimensions_ + a], 2);
      const double length = std::sqrt(square);
      if (length > reach * spacing) continue;
      const bool next = dimensions == 2 && length < 1.2 * spacing;
      bonds_.push_back({static_cast<std::uint32_t>(i), j, next ? 2.0 * unit : unit, length});
    }
  }
}

// Held components are rows of zeros, whose diagonal is set later; so the pattern stays the same.
RelaxationMass::Entries RelaxationMass::bond_entries(const double* x, const std::int64_t* held) {
  const std::size_t D = dimensions_;
  const auto is_held = [&](std::size_t k) { return (held[k / D] >> (k % D) & 1) != 0; };
  Entries entries;
  const auto add = [&](std::size_t row, std::size_t column, double value) {
    if (row >= column)
      entries.emplace_back(static_cast<int>(row), static_cast<int>(column),
                           is_held(row) || is_held(column) ? 0.0 : value);
  };
  diagonal_.assign(n_ * D, to_ground * unit_);
  for (const Bond& bond : bonds_) {
    const std::size_t i = bond.i * D, j = bond.j * D;
    std::array<double, 3> e{};
    double square = 0;
    for (std::size_t a = 0; a < D; ++a) {
      e[a] = x[j + a] - x[i + a];
      square += e[a] * e[a];
    }
    for (std::size_t a = 0; a < D; ++a)
      for (std::size_t b = 0; b < D; ++b) {
        const double k = bond.stiffness * ((1.0 - across) * e[a] * e[b] / square + (a == b ? across : 0.0));
        // Twice: what the other end of the bond takes counts as well.
        diagonal_[i + a] += 2.0 * std::fabs(k);
        diagonal_[j + a] += 2.0 * std::fabs(k);
        if (kind == MassKind::lumped) continue;
        add(i + a, i + b, k), add(j + a, j + b, k), add(i + a, j + b, -k), add(j + a, i + b, -k);
      }
  }
  return entries;
}

void RelaxationMass::assemble(const double* x, const TangentInput& input) {
  const std::size_t n = n_ * dimensions_;
  at_.assign(x, x + n);
  Entries entries = kind == MassKind::stiffness ? tangent(static_cast<int>(dimensions_), input)
                                                : bond_entries(x, input.held);
  if (kind == MassKind::lumped) return;
  for (std::size_t k = 0; k < n; ++k) {
    const bool held = (input.held[k / dimensions_] >> (k % dimensions_) & 1) != 0;
    entries.emplace_back(static_cast<int>(k), static_cast<int>(k), held ? unit_ : to_ground * unit_);
  }
  matrix_.resize(static_cast<int>(n), static_cast<int>(n));
  matrix_.setFromTriplets(entries.begin(), entries.end());
  if (!analysed_) factor_.analyzePattern(matrix_);
  analysed_ = true;
  factor_.factorize(matrix_);
  if (factor_.info() != Eigen::Success)
    throw PhysicsFailed("the stiffness of the body cannot be factorised: particles lie upon each other");
}

void RelaxationMass::multiply(const double* u, double* f) const {
  const auto n = static_cast<int>(n_ * dimensions_);
  const Eigen::Map<const Eigen::VectorXd> from(u, n);
  Eigen::Map<Eigen::VectorXd> to(f, n);
  if (kind != MassKind::lumped)
    to = matrix_.selfadjointView<Eigen::Lower>() * from;
  else
    to = Eigen::Map<const Eigen::VectorXd>(diagonal_.data(), n).cwiseProduct(from);
}

void RelaxationMass::solve(const double* f, double* u) const {
  const auto n = static_cast<int>(n_ * dimensions_);
  const Eigen::Map<const Eigen::VectorXd> from(f, n);
  Eigen::Map<Eigen::VectorXd> to(u, n);
  if (kind != MassKind::lumped)
    to = factor_.solve(from);
  else
    to = from.cwiseQuotient(Eigen::Map<const Eigen::VectorXd>(diagonal_.data(), n));
}

double RelaxationMass::changed(const double* x) const {
  std::vector<double> u(n_ * dimensions_);
  for (std::size_t k = 0; k < u.size(); ++k) u[k] = x[k] - at_[k];
  return stretch(u.data());
}

double RelaxationMass::stretch(const double* u) const {
  double largest = 0;
  for (const Bond& bond : bonds_) {
    double square = 0;
    for (std::size_t a = 0; a < dimensions_; ++a)
      square += std::pow(u[bond.j * dimensions_ + a] - u[bond.i * dimensions_ + a], 2);
    largest = std::max(largest, square / (bond.length * bond.length));
  }
  return std::sqrt(largest);
}

}  // namespace shoal::solid
