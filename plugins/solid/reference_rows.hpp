// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Weights on the way from the fit around each particle to stencils that particles share (reference_weights.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "reference_weights.hpp"

namespace shoal::solid {

// Rows of neighbours with D + 1 forward weights each, the neighbours in ascending order.
class ReferenceRows {
 public:
  // Throws CaseError if the list holds images (of periodic or mirror faces).
  ReferenceRows(int dimensions, const ReferenceSettings& settings, const shoal_neighbours& list,
                const ReferenceGeometry& geometry);

  std::uint64_t size() const { return start_.size() - 1; }
  std::uint32_t count(std::uint64_t i) const { return static_cast<std::uint32_t>(start_[i + 1] - start_[i]); }
  const std::uint32_t* neighbours(std::uint64_t i) const { return j_.data() + start_[i]; }
  const double* forward(std::uint64_t i) const { return forward_.data() + start_[i] * stride_; }
  // Weights of the neighbours towards i, times V_j / V_i.
  void backward(std::uint64_t i, const double* volume, std::vector<double>& out) const;
  const ForceConsistency& consistency() const { return consistency_; }

 private:
  template <int D>
  void fit(const ReferenceSettings& settings, const shoal_neighbours& list,
           const ReferenceGeometry& geometry);
  void sort(const shoal_neighbours& list);
  void share();

  std::size_t stride_;
  std::vector<std::uint64_t> start_;
  std::vector<std::uint32_t> j_;
  std::vector<double> forward_;
  ForceConsistency consistency_;
};

}  // namespace shoal::solid
