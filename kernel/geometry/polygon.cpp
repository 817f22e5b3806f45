// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact signed distance of a simple polygon, and the check that it is simple.
#include <cstddef>
#include <sstream>
#include <stdexcept>

#include "shape.hpp"

namespace shoal::kernel {
namespace {

double cross(const Point& a, const Point& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Twice the signed area of the triangle a, b, c: positive where they turn to the left.
double turn(const Point& a, const Point& b, const Point& c) {
  return cross(point::minus(b, a), point::minus(c, a));
}

bool between(const Point& a, const Point& b, const Point& p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
         p[1] <= std::max(a[1], b[1]);
}

/// Whether the closed segments ab and cd share a point.
bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double abc = turn(a, b, c);
  const double abd = turn(a, b, d);
  const double cda = turn(c, d, a);
  const double cdb = turn(c, d, b);
  if (((abc > 0.0 && abd < 0.0) || (abc < 0.0 && abd > 0.0)) &&
      ((cda > 0.0 && cdb < 0.0) || (cda < 0.0 && cdb > 0.0))) {
    return true;
  }
  return (abc == 0.0 && between(a, b, c)) || (abd == 0.0 && between(a, b, d)) ||
         (cda == 0.0 && between(c, d, a)) || (cdb == 0.0 && between(c, d, b));
}

std::string text(const Point& p) {
  std::ostringstream out;
  out << "(" << p[0] << ", " << p[1] << ")";
  return out.str();
}

std::vector<Point> cleaned(const std::vector<Point>& given) {
  std::vector<Point> vertices;
  for (const Point& v : given) {
    if (!point::finite(v)) throw std::invalid_argument("the vertices of a polygon must be finite");
    vertices.push_back({v[0], v[1], 0.0});
  }
  if (vertices.size() > 1 && vertices.front() == vertices.back()) vertices.pop_back();
  if (vertices.size() < 3) {
    throw std::invalid_argument("a polygon needs at least 3 different vertices, but has " +
                                std::to_string(vertices.size()));
  }
  return vertices;
}

void require_no_spikes(const std::vector<Point>& v) {
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point& b = v[(i + 1) % n];
    if (v[i] == b) throw std::invalid_argument("a polygon has the vertex " + text(b) + " twice in a row");
    const Point ab = point::minus(b, v[i]);
    const Point bc = point::minus(v[(i + 2) % n], b);
    if (cross(ab, bc) == 0.0 && point::dot(ab, bc) < 0.0) {
      throw std::invalid_argument("a polygon runs back on itself at the vertex " + text(b));
    }
  }
}

void require_simple(const std::vector<Point>& v) {
  const std::size_t n = v.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // these two edges share the first vertex
      const Point& a = v[i];
      const Point& b = v[(i + 1) % n];
      const Point& c = v[j];
      const Point& d = v[(j + 1) % n];
      if (!meet(a, b, c, d)) continue;
      throw std::invalid_argument("a polygon must not cross or touch itself, but its edges from " + text(a) +
                                  " to " + text(b) + " and from " + text(c) + " to " + text(d) + " meet");
    }
  }
}

}  // namespace

struct Polygon::Nearest {
  double squared = infinity;
  Point at{};
  std::size_t edge = 0;
  bool at_vertex = false;  // the nearest point is the first vertex of the edge
  bool inside = false;
};

Polygon::Polygon(const Parameters& parameters) : vertices_(cleaned(parameters.vertices)) {
  require_no_spikes(vertices_);
  require_simple(vertices_);
  double doubled = 0.0;
  const std::size_t n = vertices_.size();
  for (std::size_t i = 1; i + 1 < n; ++i) doubled += turn(vertices_[0], vertices_[i], vertices_[i + 1]);
  if (doubled < 0.0) std::reverse(vertices_.begin(), vertices_.end());
  area_ = 0.5 * std::abs(doubled);
  bounds_.lower = {infinity, infinity, -infinity};
  bounds_.upper = {-infinity, -infinity, infinity};
  for (const Point& v : vertices_) {
    for (std::size_t a = 0; a < 2; ++a) {
      bounds_.lower[a] = std::min(bounds_.lower[a], v[a]);
      bounds_.upper[a] = std::max(bounds_.upper[a], v[a]);
    }
  }
}

Polygon::Nearest Polygon::nearest(const Point& p) const {
  Nearest best;
  const std::size_t n = vertices_.size();
  const Point q{p[0], p[1], 0.0};
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = vertices_[i];
    const Point& b = vertices_[(i + 1) % n];
    const Point ab = point::minus(b, a);
    const Point aq = point::minus(q, a);
    // The ray towards +x from q crosses edges that have one end on or below it and the other above.
    if ((a[1] <= q[1]) != (b[1] <= q[1]) && (turn(a, b, q) > 0.0) == (b[1] > a[1]))
      best.inside = !best.inside;
    const double t = point::dot(aq, ab) / point::dot(ab, ab);
    const Point at = t <= 0.0 ? a : t >= 1.0 ? b : point::along(a, t, ab);
    const Point away = point::minus(q, at);
    const double squared = point::dot(away, away);
    if (squared < best.squared) {
      best.squared = squared;
      best.at = at;
      best.edge = t >= 1.0 ? (i + 1) % n : i;
      best.at_vertex = t <= 0.0 || t >= 1.0;
    }
  }
  return best;
}

bool Polygon::holds(const Point& p, double tolerance) const {
  return nearest(point::along(p, tolerance, point::upper_side)).inside;
}

double Polygon::signed_distance(const Point& p) const {
  const Nearest best = nearest(p);
  const double distance = std::sqrt(best.squared);
  return best.inside ? -distance : distance;
}

Point Polygon::edge_normal(std::size_t edge) const {
  const Point along = point::minus(vertices_[(edge + 1) % vertices_.size()], vertices_[edge]);
  return point::unit({along[1], -along[0], 0.0}, {1.0, 0.0, 0.0});
}

Point Polygon::normal(const Point& p) const {
  const Nearest best = nearest(p);
  const Point own = edge_normal(best.edge);
  if (!best.at_vertex) return own;
  // At a vertex the gradient points away from it, but close by rounding leaves no direction: take the
  // bisector.
  const std::size_t before = (best.edge + vertices_.size() - 1) % vertices_.size();
  const Point bisector = point::unit(point::plus(own, edge_normal(before)), own);
  const double tiny = 1e-12 * (point::length(best.at) + bounds_.upper[0] - bounds_.lower[0]);
  if (best.squared <= tiny * tiny) return bisector;
  const Point away{p[0] - best.at[0], p[1] - best.at[1], 0.0};
  return point::unit(point::times(best.inside ? -1.0 : 1.0, away), bisector);
}

}  // namespace shoal::kernel
