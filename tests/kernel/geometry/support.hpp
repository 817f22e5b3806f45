// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Slow and obvious references for the geometry: distances to a dense sampling of a surface, differences of
// the distance, and reproducible random points.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "kernel/geometry/shape.hpp"

namespace shoal::kernel::test {

inline std::vector<Point> random_points(std::size_t count, const Point& lower, const Point& upper,
                                        unsigned seed = 7) {
  std::mt19937_64 engine(seed);
  std::vector<Point> points(count);
  for (Point& p : points) {
    for (std::size_t a = 0; a < 3; ++a) {
      // Not std::uniform_real_distribution: its values differ between libraries.
      p[a] = lower[a] + (upper[a] - lower[a]) * static_cast<double>(engine() >> 11) * 0x1.0p-53;
    }
  }
  return points;
}

/// Points of the segment from a to b, `count` intervals, ends included.
inline void sample_segment(std::vector<Point>& samples, const Point& a, const Point& b, int count) {
  for (int i = 0; i <= count; ++i) {
    samples.push_back(point::along(a, static_cast<double>(i) / count, point::minus(b, a)));
  }
}

inline std::vector<Point> sample_polygon(const std::vector<Point>& vertices, int count) {
  std::vector<Point> samples;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    sample_segment(samples, vertices[i], vertices[(i + 1) % vertices.size()], count);
  }
  return samples;
}

/// Samples of all faces of a box in three dimensions.
inline std::vector<Point> sample_box(const Point& lower, const Point& upper, int count) {
  std::vector<Point> samples;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3;
    const std::size_t c = (a + 2) % 3;
    for (const double level : {lower[a], upper[a]}) {
      for (int i = 0; i <= count; ++i) {
        for (int j = 0; j <= count; ++j) {
          Point p{};
          p[a] = level;
          p[b] = lower[b] + (upper[b] - lower[b]) * i / count;
          p[c] = lower[c] + (upper[c] - lower[c]) * j / count;
          samples.push_back(p);
        }
      }
    }
  }
  return samples;
}

inline double brute_distance(const std::vector<Point>& surface, const Point& p) {
  double least = infinity;
  for (const Point& s : surface) {
    const Point away = point::minus(p, s);
    least = std::min(least, point::dot(away, away));
  }
  return std::sqrt(least);
}

/// Compares with a surface of which every point has a sample within `gap`: the brute distance d is then
/// between the true one, D, and sqrt(D^2 + gap^2), up to the curvature of the surface.
inline void check_exact_distance(const Shape& shape, const std::vector<Point>& surface, double gap,
                                 const std::vector<Point>& where,
                                 const std::function<bool(const Point&)>& inside) {
  int ins = 0;
  int outs = 0;
  for (const Point& p : where) {
    CAPTURE(p[0]);
    CAPTURE(p[1]);
    CAPTURE(p[2]);
    const double d = shape.signed_distance(p);
    const double brute = brute_distance(surface, p);
    CHECK(std::abs(d) <= brute + 1e-12);
    CHECK(brute <= std::sqrt(d * d + gap * gap) + 0.05 * gap);
    CHECK((d < 0.0) == inside(p));
    CHECK(shape.contains(p) == inside(p));
    ++(inside(p) ? ins : outs);
  }
  CHECK(ins > 50);  // the sample must see both sides, or it proves nothing
  CHECK(outs > 50);
}

/// A bound: sign exact, never beyond the true distance.
inline void check_bound(const Shape& shape, const std::vector<Point>& surface,
                        const std::vector<Point>& where, const std::function<bool(const Point&)>& inside) {
  for (const Point& p : where) {
    CAPTURE(p[0]);
    CAPTURE(p[1]);
    CAPTURE(p[2]);
    const double d = shape.signed_distance(p);
    CHECK(std::abs(d) <= brute_distance(surface, p) + 1e-12);
    CHECK((d < 0.0) == inside(p));
    CHECK(shape.contains(p) == inside(p));
  }
}

/// |d(p) - d(q)| <= |p - q|, near and far: what the generator's strides rest on.
inline void check_lipschitz(const Shape& shape, const std::vector<Point>& where) {
  double steepest = 0.0;
  for (std::size_t i = 1; i < where.size(); ++i) {
    for (const double share : {1.0, 1e-3}) {
      const Point q = point::along(where[i], share, point::minus(where[i - 1], where[i]));
      const double apart = point::length(point::minus(q, where[i]));
      const double change = std::abs(shape.signed_distance(q) - shape.signed_distance(where[i]));
      steepest = std::max(steepest, change / apart);
    }
  }
  CHECK(steepest <= 1.0 + 1e-9);
}

/// Normals against central differences of the distance. Points at which the differences do not have unit
/// length are on a ridge and are left out, but only `ridges` (a share) may be.
inline void check_normals(const Shape& shape, const std::vector<Point>& where, double ridges = 0.02) {
  const double step = 1e-6;
  std::size_t left_out = 0;
  for (const Point& p : where) {
    Point gradient{};
    for (std::size_t a = 0; a < 3; ++a) {
      Point ahead = p;
      Point behind = p;
      ahead[a] += step;
      behind[a] -= step;
      gradient[a] = (shape.signed_distance(ahead) - shape.signed_distance(behind)) / (2.0 * step);
    }
    const Point n = shape.normal(p);
    CHECK(point::length(n) == doctest::Approx(1.0).epsilon(1e-12));
    if (std::abs(point::length(gradient) - 1.0) > 1e-4) {
      ++left_out;
      continue;
    }
    CAPTURE(p[0]);
    CAPTURE(p[1]);
    CAPTURE(p[2]);
    CHECK(point::length(point::minus(n, gradient)) < 1e-4);
  }
  CHECK(static_cast<double>(left_out) <= ridges * static_cast<double>(where.size()));
}

/// The text with which `make` refuses, or "" if it does not.
template <class Exception, class Make>
std::string refusal(Make make) {
  try {
    (void)make();
  } catch (const Exception& e) {
    return e.what();
  }
  return {};
}

}  // namespace shoal::kernel::test
