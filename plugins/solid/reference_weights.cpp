// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "reference_weights.hpp"

#include <cmath>
#include <cstring>
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
}

// Rows with the same bits in both directions become one pattern, and neighbours in the body's order one run.
void ReferenceWeights::keep(const ReferenceRows& rows, const double* volume) {
  runs_.clear(), patterns_.clear(), offsets_.clear(), forward_.clear(), backward_.clear(), sums_.clear();
  std::unordered_multimap<std::uint64_t, std::uint32_t> known;
  std::vector<std::int32_t> offset;
  std::vector<double> back, sum(stride_);
  for (std::uint64_t i = 0; i < n_; ++i) {
    const std::uint32_t n = rows.count(i);
    const std::size_t numbers = n * stride_;
    const double* there = rows.forward(i);
    offset.resize(n);
    for (std::uint32_t m = 0; m < n; ++m)
      offset[m] = static_cast<std::int32_t>(static_cast<std::int64_t>(rows.neighbours(i)[m]) -
                                            static_cast<std::int64_t>(i));
    rows.backward(i, volume, back);
    const auto is = [&](std::uint32_t pattern) {
      const Pattern& other = patterns_[pattern];
      return other.n == n &&
             std::equal(offset.begin(), offset.end(),
                        offsets_.begin() + static_cast<std::ptrdiff_t>(other.first)) &&
             std::equal(there, there + numbers, forward_.data() + other.first * stride_) &&
             std::equal(back.begin(), back.end(), backward_.data() + other.first * stride_);
    };
    if (i > 0 && is(runs_.back().pattern)) continue;
    std::uint64_t hash = hash_of(1469598103934665603u, offset.data(), n * sizeof offset[0]);
    hash = hash_of(hash, there, numbers * sizeof(double));
    hash = hash_of(hash, back.data(), numbers * sizeof(double));
    const auto [first, last] = known.equal_range(hash);
    const auto found = std::find_if(first, last, [&](const auto& entry) { return is(entry.second); });
    if (found != last) {
      runs_.push_back({static_cast<std::uint32_t>(i), found->second});
      continue;
    }
    const auto pattern = static_cast<std::uint32_t>(patterns_.size());
    patterns_.push_back({n, offsets_.size()});
    offsets_.insert(offsets_.end(), offset.begin(), offset.end());
    forward_.insert(forward_.end(), there, there + numbers);
    backward_.insert(backward_.end(), back.begin(), back.end());
    sum.assign(stride_, 0.0);
    for (std::size_t k = 0; k < numbers; ++k) sum[k % stride_] += there[k];
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
  for_each_run(0, n_, [&](std::uint64_t a, std::uint64_t b, const Stencil& stencil) {
    deform_run<D>(stencil, a, b, u, q_factor, stress, held);
  });
  for (std::uint64_t i = 0; i < n_; ++i) {
    Mat<D> gradient;
    std::copy_n(stress + i * D * D, D * D, gradient.e);
    const Mat<D> strain = symmetric_part(gradient);
    const Mat<D> s = stiffness.lambda * trace(strain) * identity<D>() + 2.0 * stiffness.mu * strain;
    std::copy_n(s.e, D * D, stress + i * D * D);
  }
  for_each_run(0, n_, [&](std::uint64_t a, std::uint64_t b, const Stencil& stencil) {
    force_run<D, true>(stencil, a, b, stress, held, 1.0, out);
  });
}

void ReferenceWeights::linear_force(const Stiffness& stiffness, const double* u, double* out,
                                    LinearSpace& space) const {
  dimensions_ == 2 ? linear_force<2>(stiffness, u, out, space) : linear_force<3>(stiffness, u, out, space);
}

// Small displacements u of an isotropic body: w^2 is the largest eigenvalue of u -> -f(u) / rho.
double ReferenceWeights::largest_frequency(const Stiffness& stiffness) const {
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
    linear_force(stiffness, u.data(), f.data(), space);
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
