// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The little vector arithmetic that shapes and generators need. Named functions rather than operators,
// because Point is a std::array and operators on it would leak into every user of the alias.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace shoal::kernel {

/// A place or a direction. In two dimensions the third component is zero.
using Point = std::array<double, 3>;

namespace point {

[[nodiscard]] inline Point plus(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
[[nodiscard]] inline Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Point times(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// a + s b
[[nodiscard]] inline Point along(const Point& a, double s, const Point& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
[[nodiscard]] inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline double length(const Point& a) { return std::sqrt(dot(a, a)); }

/// The unit vector along `a`, or `otherwise` where `a` has no direction.
[[nodiscard]] inline Point unit(const Point& a, const Point& otherwise) {
  const double norm = length(a);
  return norm > 0.0 && std::isfinite(norm) ? times(1.0 / norm, a) : otherwise;
}

/// Points on a flat face belong to the side that this direction leads to, the upper one. Its components
/// differ, so that faces along a diagonal are decided as well.
inline constexpr Point upper_side{1.0, 0.618, 0.382};

[[nodiscard]] inline bool finite(const Point& a) {
  return std::all_of(a.begin(), a.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace point
}  // namespace shoal::kernel
