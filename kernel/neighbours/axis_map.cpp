// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/neighbours/axis_map.hpp"

namespace shoal::kernel {

void AxisMap::set_uniform(double lower, double upper, double width, int divisions) {
  segments_.clear();
  lower_ = lower;
  divisions_ = divisions;
  per_width_ = 1.0 / width;
  per_cell_ = divisions / width;
  // Callers bound the number of cells before they build one; the limit keeps the conversion defined.
  const double last = std::floor((upper - lower) * per_cell_);
  cells_ = 1 + static_cast<std::int64_t>(std::min(last, far));
}

void AxisMap::set_compressed(const double* coordinates, std::size_t n, std::size_t stride, double width,
                             int divisions) {
  lower_ = 0.0;
  divisions_ = divisions;
  per_width_ = 1.0 / width;
  per_cell_ = divisions / width;
  segments_.clear();
  std::vector<double> slices(n);
  for (std::size_t i = 0; i < n; ++i) slices[i] = std::floor(coordinates[i * stride] * per_width_);
  std::sort(slices.begin(), slices.end());
  double offset = 0.0;
  for (double slice : slices) {
    if (!segments_.empty()) {
      Segment& last = segments_.back();
      const double end = last.first + last.length;
      if (slice < end) continue;
      if (slice <= end + 2.0) {  // a gap of up to two slices is kept as it is
        last.length = slice + 1.0 - last.first;
        continue;
      }
      offset = last.offset + last.length + 2.0;
    }
    segments_.push_back({slice, 1.0, offset});
  }
  cells_ = segments_.empty()
               ? 1
               : static_cast<std::int64_t>(segments_.back().offset + segments_.back().length) * divisions;
}

double AxisMap::locate_in_segments(double x) const {
  const double s = x * per_width_;
  auto next =
      std::upper_bound(segments_.begin(), segments_.end(), s,
                       [](double value, const Segment& segment) { return value < segment.first - 1.0; });
  // `next` is the first segment that begins more than one slice above s.
  if (next == segments_.begin()) return -far;
  const Segment& segment = *std::prev(next);
  // One slice beyond the end keeps its distance; what lies further in the gap is no one's neighbour.
  return (segment.offset + std::min(s - segment.first, segment.length + 1.0)) * divisions_;
}

}  // namespace shoal::kernel
