// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The box that particles live in, and what its faces do.
#pragma once

#include <limits>

namespace shoal::kernel {

enum class BoundaryKind { open, periodic, mirror };

/// An axis is periodic at both faces or at neither; mirror planes may stand at either face.
struct AxisBoundary {
  BoundaryKind lower = BoundaryKind::open;
  BoundaryKind upper = BoundaryKind::open;
};

struct Domain {
  int dimensions = 3;
  double lower[3] = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                     -std::numeric_limits<double>::infinity()};
  double upper[3] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                     std::numeric_limits<double>::infinity()};
  AxisBoundary boundary[3];

  bool periodic(int axis) const { return boundary[axis].lower == BoundaryKind::periodic; }
  double length(int axis) const { return upper[axis] - lower[axis]; }
  bool has_images() const {
    for (int axis = 0; axis < dimensions; ++axis)
      if (boundary[axis].lower != BoundaryKind::open || boundary[axis].upper != BoundaryKind::open)
        return true;
    return false;
  }
  bool any_periodic() const {
    for (int axis = 0; axis < dimensions; ++axis)
      if (periodic(axis)) return true;
    return false;
  }
};

}  // namespace shoal::kernel
