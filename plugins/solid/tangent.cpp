// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "tangent.hpp"

#include <Eigen/Dense>
#include <map>

#include "shoal/eigen.hpp"

namespace shoal::solid {
namespace {

// The rotation of F = R U.
template <int D>
Mat<D> rotation(const double* F) {
  Mat<D> f;
  std::copy_n(F, D * D, f.e);
  if constexpr (D == 2) {
    const double c = f(0, 0) + f(1, 1), s = f(1, 0) - f(0, 1), size = std::sqrt(c * c + s * s);
    if (!(size > 0.0)) return identity<2>();
    Mat<2> R;
    R(0, 0) = R(1, 1) = c / size, R(1, 0) = s / size, R(0, 1) = -s / size;
    return R;
  } else {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(as_eigen(f), Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d R = svd.matrixU() * svd.matrixV().transpose();
    Mat<3> made;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) made(a, b) = R(a, b);
    return made;
  }
}

template <int D>
class Assembly {
 public:
  explicit Assembly(const TangentInput& input) : in_(input) {}

  std::vector<Eigen::Triplet<double>> run() {
    for (std::uint64_t i = 0; i < in_.n; ++i) particle(i);
    if (in_.stiffness.grid != nullptr)
      for (std::size_t c = 0; c < in_.stiffness.grid->n_nodes(); ++c) node(c);
    return std::move(entries_);
  }

 private:
  struct Weight {
    std::uint64_t j;
    Vec<D> G;  // turned with particle i
    double psi;
  };

  // Calls add(j, weights, sign) for the neighbours of particle i and i itself.
  template <class Add>
  void for_each_weight(std::uint64_t i, const Add& add) const {
    const Stencil stencil = in_.weights.stencil(i);
    for (std::uint32_t m = 0; m < stencil.n; ++m)
      add(static_cast<std::uint64_t>(static_cast<std::int64_t>(i) + stencil.offset[m]),
          stencil.forward + m * (D + 1), 1.0);
    add(i, stencil.sums, -1.0);
  }
  static Vec<D> vector(const double* g, double sign) {
    Vec<D> G;
    for (int a = 0; a < D; ++a) G[a] = sign * g[a];
    return G;
  }

  // Of the mean volume at a node of the grid of pressure.
  void node(std::size_t c) {
    std::map<std::uint64_t, Vec<D>> mean;  // its derivative by the position of each particle
    in_.stiffness.grid->for_each_particle(c, [&](std::uint32_t i, double share) {
      const Mat<D> R = rotation<D>(in_.F + std::size_t{i} * D * D);
      for_each_weight(i, [&](std::uint64_t j, const double* g, double sign) {
        mean.try_emplace(j, Vec<D>{}).first->second += share * (R * vector(g, sign));
      });
    });
    const double factor = in_.stiffness.grid->volume(c) * in_.stiffness.bulk;
    for (const auto& [a, by_a] : mean)
      for (const auto& [b, by_b] : mean)
        if (a >= b) block(a, b, factor * outer(by_a, by_b));
  }
  void particle(std::uint64_t i) {
    const Mat<D> R = rotation<D>(in_.F + i * D * D);
    around_.clear();
    for_each_weight(i, [&](std::uint64_t j, const double* g, double sign) {
      around_.push_back({j, vector(g, sign), sign * g[D]});
    });
    const double V = in_.volume[i], mu = V * in_.stiffness.mu;
    const double lambda = V * (in_.stiffness.lambda - in_.stiffness.bulk);
    const double hourglass = V * in_.stiffness.hourglass / (in_.spacing * in_.spacing);
    for (Weight& weight : around_) turned_.push_back(R * weight.G);
    for (std::size_t a = 0; a < around_.size(); ++a)
      for (std::size_t b = 0; b < around_.size(); ++b) {
        if (around_[a].j < around_[b].j) continue;
        const double both =
            mu * dot(around_[a].G, around_[b].G) + hourglass * around_[a].psi * around_[b].psi;
        block(around_[a].j, around_[b].j,
              lambda * outer(turned_[a], turned_[b]) + mu * outer(turned_[b], turned_[a]) +
                  both * identity<D>());
      }
    turned_.clear();
  }
  void block(std::uint64_t a, std::uint64_t b, const Mat<D>& k) {
    for (int r = 0; r < D; ++r)
      for (int c = 0; c < D; ++c) {
        const std::uint64_t row = a * D + static_cast<std::uint64_t>(r),
                            column = b * D + static_cast<std::uint64_t>(c);
        if (row < column) continue;
        const bool fixed = (in_.held[a] >> r & 1) != 0 || (in_.held[b] >> c & 1) != 0;
        entries_.emplace_back(static_cast<int>(row), static_cast<int>(column), fixed ? 0.0 : k(r, c));
      }
  }

  const TangentInput& in_;
  std::vector<Weight> around_;
  std::vector<Vec<D>> turned_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

std::vector<Eigen::Triplet<double>> tangent(int dimensions, const TangentInput& input) {
  return dimensions == 2 ? Assembly<2>(input).run() : Assembly<3>(input).run();
}

}  // namespace shoal::solid
