// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_weights.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include "reference_rows.hpp"

namespace shoal::solid {
namespace {

// Loads of four numbers may begin at the last one.
constexpr std::size_t behind = 8;

std::uint64_t hash_of(std::uint64_t hash, const void* data, std::size_t bytes) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (std::size_t k = 0; k + 4 <= bytes; k += 4) {
    std::uint32_t word;
    std::memcpy(&word, p + k, sizeof word);
    hash = (hash ^ word) * 1099511628211u;
  }
  return hash;
}

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
  const ReferenceRows rows(dimensions, settings, list, geometry);
  consistency_ = rows.consistency();
  keep(rows, geometry.volume);
  if (geometry.held != nullptr && !geometry.held->empty()) look_at_held(*geometry.held);
}

void ReferenceWeights::look_at_held(const HeldSurface& held) {
  const auto d = static_cast<std::size_t>(dimensions_);
  corrections_.clear();
  for (std::uint64_t i = 0; i < n_; ++i) {
    Correction made{i, {}, {}};
    if (held.holds(i)) {
      for (std::size_t a = 0; a < d; ++a) made.F[a * (d + 1)] = 1.0;
      corrections_.push_back(made);
      continue;
    }
    const Stencil s = stencil(i);
    bool any = false;
    for (std::uint32_t m = 0; m < s.n; ++m) {
      const auto j = static_cast<std::uint64_t>(static_cast<std::int64_t>(i) + s.offset[m]);
      if (!held.shows(j)) continue;
      any = true;
      const double* w = s.forward + m * stride_;
      for (std::size_t a = 0; a < d; ++a) {
        for (std::size_t b = 0; b < d; ++b) made.F[a * d + b] -= held.shift[j * d + a] * w[b];
        made.residual[a] += held.shift[j * d + a] * w[d];
      }
    }
    if (any) corrections_.push_back(made);
  }
}

// A row in both directions, neighbours with hourglass weights in front.
class ReferenceWeights::SortedRow {
 public:
  std::uint32_t n = 0, controlled = 0;
  std::vector<std::int32_t> offset;
  std::vector<double> forward, backward;

  void look(const ReferenceRows& rows, const double* volume, std::uint64_t i, std::size_t stride) {
    n = rows.count(i);
    rows.backward(i, volume, back_);
    const double* there = rows.forward(i);
    order_.resize(n);
    std::iota(order_.begin(), order_.end(), 0u);
    const auto behind_them = std::stable_partition(order_.begin(), order_.end(), [&](std::uint32_t m) {
      return there[(m + 1) * stride - 1] != 0.0 || back_[(m + 1) * stride - 1] != 0.0;
    });
    controlled = static_cast<std::uint32_t>(behind_them - order_.begin());
    offset.clear(), forward.clear(), backward.clear();
    for (const std::uint32_t m : order_) {
      offset.push_back(static_cast<std::int32_t>(static_cast<std::int64_t>(rows.neighbours(i)[m]) -
                                                 static_cast<std::int64_t>(i)));
      forward.insert(forward.end(), there + m * stride, there + (m + 1) * stride);
      const auto from = back_.begin() + static_cast<std::ptrdiff_t>(m * stride);
      backward.insert(backward.end(), from, from + static_cast<std::ptrdiff_t>(stride));
    }
  }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<double> back_;
};

// Rows with the same bits in both directions become one pattern, and neighbours in the body's order one run.
void ReferenceWeights::keep(const ReferenceRows& rows, const double* volume) {
  runs_.clear(), patterns_.clear(), offsets_.clear(), forward_.clear(), backward_.clear(), sums_.clear();
  std::unordered_multimap<std::uint64_t, std::uint32_t> known;
  SortedRow row;
  std::vector<double> sum(stride_);
  for (std::uint64_t i = 0; i < n_; ++i) {
    row.look(rows, volume, i, stride_);
    const auto is = [&](std::uint32_t pattern) {
      const Pattern& other = patterns_[pattern];
      return other.n == row.n &&
             std::equal(row.offset.begin(), row.offset.end(),
                        offsets_.begin() + static_cast<std::ptrdiff_t>(other.first)) &&
             std::equal(row.forward.begin(), row.forward.end(), forward_.data() + other.first * stride_) &&
             std::equal(row.backward.begin(), row.backward.end(), backward_.data() + other.first * stride_);
    };
    if (i > 0 && is(runs_.back().pattern)) continue;
    const std::size_t numbers = row.forward.size();
    std::uint64_t hash = hash_of(1469598103934665603u, row.offset.data(), row.n * sizeof(std::int32_t));
    hash = hash_of(hash, row.forward.data(), numbers * sizeof(double));
    hash = hash_of(hash, row.backward.data(), numbers * sizeof(double));
    const auto [first, last] = known.equal_range(hash);
    const auto found = std::find_if(first, last, [&](const auto& entry) { return is(entry.second); });
    if (found != last) {
      runs_.push_back({static_cast<std::uint32_t>(i), found->second});
      continue;
    }
    const auto pattern = static_cast<std::uint32_t>(patterns_.size());
    patterns_.push_back({row.n, row.controlled, offsets_.size()});
    offsets_.insert(offsets_.end(), row.offset.begin(), row.offset.end());
    forward_.insert(forward_.end(), row.forward.begin(), row.forward.end());
    backward_.insert(backward_.end(), row.backward.begin(), row.backward.end());
    sum.assign(stride_, 0.0);
    for (std::size_t k = 0; k < numbers; ++k) sum[k % stride_] += row.forward[k];
    sums_.insert(sums_.end(), sum.begin(), sum.end());
    known.emplace(hash, pattern);
    runs_.push_back({static_cast<std::uint32_t>(i), pattern});
  }
  runs_.push_back({static_cast<std::uint32_t>(n_), 0});
  for (std::vector<double>* numbers : {&forward_, &backward_, &sums_}) {
    numbers->resize(numbers->size() + behind, 0.0);
    numbers->shrink_to_fit();
  }
  offsets_.shrink_to_fit();
}

void ReferenceWeights::residual(std::uint64_t i, double* out) const {
  const auto d = static_cast<std::size_t>(dimensions_);
  const Stencil s = stencil(i);
  std::copy_n(s.sums, d, out);
  for (std::uint32_t m = 0; m < s.n; ++m)
    for (std::size_t k = 0; k < d; ++k) out[k] -= s.backward[m * stride_ + k];
}

std::uint64_t ReferenceWeights::bytes() const {
  return sizeof(double) * (forward_.size() + backward_.size() + sums_.size()) +
         sizeof(std::int32_t) * offsets_.size() + sizeof(Run) * runs_.size() +
         sizeof(Pattern) * patterns_.size();
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
void ReferenceWeights::linear_force(const Stiffness& stiffness, const double* u, double* out,
                                    LinearSpace& space) const {
  if (space.stress.size() == 0) space.stress.assign(n_ * D * D), space.held.assign(n_ * D);
  double *stress = space.stress.data(), *held = space.held.data();
  const double q_factor = stiffness.hourglass / (spacing_ * spacing_);
  deform<D>(0, n_, u, q_factor, stress, held);
  const PressureGrid* grid = stiffness.grid;
  if (grid != nullptr) {
    space.trace.assign(n_, 0.0), space.nodes.resize(grid->n_nodes());
    for (std::uint64_t i = 0; i < n_; ++i)
      for (int a = 0; a < D; ++a) space.trace[i] += stress[i * D * D + static_cast<std::size_t>(a * (D + 1))];
    grid->means(space.trace.data(), space.nodes.data());
  }
  for (std::uint64_t i = 0; i < n_; ++i) {
    Mat<D> gradient;
    std::copy_n(stress + i * D * D, D * D, gradient.e);
    const Mat<D> strain = symmetric_part(gradient);
    double volumetric = stiffness.lambda * trace(strain);
    if (grid != nullptr) volumetric += stiffness.bulk * (grid->at(i, space.nodes.data()) - trace(strain));
    const Mat<D> s = volumetric * identity<D>() + 2.0 * stiffness.mu * strain;
    std::copy_n(s.e, D * D, stress + i * D * D);
  }
  force<D, true>(0, n_, stress, held, 1.0, out);
}

void ReferenceWeights::linear_force(const Stiffness& stiffness, const double* u, double* out,
                                    LinearSpace& space) const {
  dimensions_ == 2 ? linear_force<2>(stiffness, u, out, space) : linear_force<3>(stiffness, u, out, space);
}

// Small displacements u of an isotropic body: w^2 is the largest eigenvalue of u -> -f(u) / rho, which is symmetric with
// volumes as weights. The iteration of Lanczos (1950) finds it as that of a tridiagonal matrix; power iteration needs the
// square of as many steps, since the upper end of the spectrum is dense.
double ReferenceWeights::largest_frequency(const Stiffness& stiffness, const double* volume) const {
  constexpr int most = 60;
  const auto d = static_cast<std::size_t>(dimensions_);
  const std::size_t n = n_ * d;
  const auto product = [&](const double* a, const double* b) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += volume[k / d] * a[k] * b[k];
    return sum;
  };
  AlignedNumbers before, u, f;
  before.assign(n), f.assign(n), random_start(u);
  LinearSpace space;
  std::vector<double> diagonal, beside;
  double length = std::sqrt(product(u.data(), u.data()));
  for (std::size_t k = 0; k < n; ++k) u.data()[k] /= length;
  for (int iteration = 0; iteration < most; ++iteration) {
    linear_force(stiffness, u.data(), f.data(), space);
    for (std::size_t k = 0; k < n; ++k)
      f.data()[k] =
          f.data()[k] / -stiffness.density - (beside.empty() ? 0.0 : beside.back()) * before.data()[k];
    diagonal.push_back(product(u.data(), f.data()));
    for (std::size_t k = 0; k < n; ++k) f.data()[k] -= diagonal.back() * u.data()[k];
    length = std::sqrt(product(f.data(), f.data()));
    if (!(length > 1e-10 * diagonal.front())) break;
    beside.push_back(length);
    for (std::size_t k = 0; k < n; ++k) f.data()[k] /= length;
    std::swap(before, u), std::swap(u, f);
  }
  const auto size = static_cast<Eigen::Index>(diagonal.size());
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(
      Eigen::Map<const Eigen::VectorXd>(diagonal.data(), size),
      Eigen::Map<const Eigen::VectorXd>(beside.data(), std::max<Eigen::Index>(size - 1, 0)),
      Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[size - 1]));
}

}  // namespace shoal::solid
