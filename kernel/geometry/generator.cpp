// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Lattice points of a shape, row by row.
#include "generator.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace shoal::kernel {
namespace {

constexpr double tie_tolerance = 1e-6;  // in spacings; far above rounding, far below anything that matters

void require_fillable(const Shape& shape, double spacing, int dimension) {
  std::ostringstream out;
  if (dimension != 2 && dimension != 3) {
    out << "particles fill 2 or 3 dimensions, not " << dimension;
  } else if (!(std::isfinite(spacing) && spacing > 0.0)) {
    out << "the particle spacing must be positive, but is " << spacing;
  } else if (!shape.valid_in(dimension)) {
    out << "this shape has no meaning in " << dimension << " dimensions";
  } else {
    const Box box = shape.bounds();
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
      if (std::isfinite(box.lower[a]) && std::isfinite(box.upper[a])) continue;
      if (box.lower[a] > box.upper[a]) continue;
      out << "a shape that does not end along "
          << "xyz"[a] << " cannot be filled with particles; intersect it with a box";
      throw std::invalid_argument(out.str());
    }
    return;
  }
  throw std::invalid_argument(out.str());
}

[[noreturn]] void refuse_count(const std::string& need, const Box& box, double spacing, std::uint64_t limit) {
  std::ostringstream out;
  out << "filling the shape at spacing " << spacing << " needs " << need << ", but the limit is " << limit
      << " particles; its bounds are (" << box.lower[0] << ", " << box.lower[1] << ", " << box.lower[2]
      << ") to (" << box.upper[0] << ", " << box.upper[1] << ", " << box.upper[2]
      << "); take a larger spacing";
  throw std::length_error(out.str());
}

std::string about(double count, const char* what) {
  std::ostringstream out;
  out << "about " << count << " " << what;
  return out.str();
}

/// Distances of the lattice along the axes, and the offsets of its rows.
struct Steps {
  Point step{};
  Lattice kind;
  int dimension;

  Steps(double spacing, int dim, Lattice lattice)
      : step{spacing, spacing, spacing}, kind(lattice), dimension(dim) {
    if (kind == Lattice::cubic) return;
    // Neighbour distance at which a particle has the volume spacing^d.
    const double a = spacing * (dim == 2 ? std::sqrt(2.0 / std::sqrt(3.0)) : std::pow(2.0, 1.0 / 6.0));
    step = {a, a * std::sqrt(0.75), a * std::sqrt(2.0 / 3.0)};
  }

  static bool odd(std::int64_t k) { return (k & 1) != 0; }

  /// Shift of row (j, k) along x, in steps. Symmetric about the cell, so that a box n steps wide holds n in
  /// each row.
  [[nodiscard]] double shift_x(std::int64_t j, std::int64_t k) const {
    if (kind == Lattice::cubic) return 0.0;
    return odd(j) != odd(k) ? 0.25 : -0.25;
  }
  [[nodiscard]] double shift_y(std::int64_t k) const {
    if (kind == Lattice::cubic || dimension == 2) return 0.0;
    return odd(k) ? 1.0 / 6.0 : -1.0 / 6.0;
  }
};

/// Indices of the lattice planes that may lie within [lower, upper]; one to spare on either side.
struct Range {
  std::int64_t first = 0;
  std::int64_t last = -1;
};

Range range_of(double lower, double upper, double origin, double step) {
  if (!(lower <= upper)) return {};
  const double first = std::floor((lower - origin) / step - 0.5) - 1.0;
  const double last = std::ceil((upper - origin) / step - 0.5) + 1.0;
  if (!(std::abs(first) < 4e15 && std::abs(last) < 4e15)) {
    throw std::length_error("the lattice has more planes along an axis than a double can tell apart");
  }
  return {static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)};
}

/// Volume of a shape by halving its bounds wherever the distance does not decide; the surface counts as flat
/// in what is left at the end.
double volume_within(const Shape& shape, const Box& box, int dimension, int halvings, double smallest) {
  Point centre{};
  double volume = 1.0;
  double squared = 0.0;
  std::size_t longest = 0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    const double side = box.upper[a] - box.lower[a];
    centre[a] = box.lower[a] + 0.5 * side;
    volume *= side;
    squared += 0.25 * side * side;
    if (side > box.upper[longest] - box.lower[longest]) longest = a;
  }
  const double distance = shape.signed_distance(centre);
  if (std::abs(distance) >= std::sqrt(squared)) return distance < 0.0 ? volume : 0.0;
  if (halvings == 0 || box.upper[longest] - box.lower[longest] < smallest) {
    const Point normal = shape.normal(centre);
    double across = 0.0;  // the cell's width as the surface sees it
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
      across += std::abs(normal[a]) * (box.upper[a] - box.lower[a]);
    }
    return volume * std::clamp(0.5 - distance / across, 0.0, 1.0);
  }
  Box low = box;
  Box high = box;
  low.upper[longest] = high.lower[longest] = centre[longest];
  return volume_within(shape, low, dimension, halvings - 1, smallest) +
         volume_within(shape, high, dimension, halvings - 1, smallest);
}

class RowFiller {
 public:
  RowFiller(const Shape& shape, double spacing, const LatticeOptions& options, const Steps& steps)
      : shape_(shape), spacing_(spacing), options_(options), steps_(steps), box_(shape.bounds()) {}

  void row(std::int64_t j, std::int64_t k) {
    const double start = options_.origin[0] + steps_.shift_x(j, k) * steps_.step[0];
    const Range range = range_of(box_.lower[0], box_.upper[0], start, steps_.step[0]);
    Point p{};
    p[1] = at(1, j) + steps_.shift_y(k) * steps_.step[1];
    if (steps_.dimension == 3) p[2] = at(2, k);
    const auto x = [&](std::int64_t i) { return centre(start, i, steps_.step[0]); };
    for (std::int64_t i = range.first; i <= range.last;) {
      p[0] = x(i);
      const double distance = shape_.signed_distance(p);
      const std::int64_t sure = std::min(range.last - i, stride(distance));
      if (sure < 0) {
        if (shape_.contains(p, tie_tolerance * spacing_)) add(p);
        ++i;
        continue;
      }
      const std::int64_t end = i + sure;
      if (distance < 0.0) {
        for (; i <= end; ++i) add({x(i), p[1], p[2]});
      }
      i = end + 1;
    }
  }

  [[nodiscard]] std::vector<Point> take() { return std::move(points_); }

 private:
  [[nodiscard]] double at(std::size_t axis, std::int64_t index) const {
    return centre(options_.origin[axis], index, steps_.step[axis]);
  }

  // Rounded once: left to the compiler, some of the places that use it may fuse product and sum and others not, and a
  // point's last bit would tell in which it was found.
  [[nodiscard]] static double centre(double start, std::int64_t index, double step) {
    return std::fma(static_cast<double>(index) + 0.5, step, start);
  }

  /// How many points beyond this one surely lie on the same side of the surface; -1 where not even this one.
  [[nodiscard]] std::int64_t stride(double distance) const {
    const double steps = (std::abs(distance) - 1e-3 * spacing_) / steps_.step[0];
    if (!(steps >= 0.0)) return -1;
    return steps > 1e15 ? std::int64_t{1} << 50 : static_cast<std::int64_t>(steps);
  }

  void add(const Point& p) {
    if (points_.size() >= options_.limit) {
      refuse_count("more particles", box_, spacing_, options_.limit);
    }
    points_.push_back(p);
  }

  const Shape& shape_;
  double spacing_;
  const LatticeOptions& options_;
  const Steps& steps_;
  Box box_;
  std::vector<Point> points_;
};

}  // namespace

double lattice_volume(double spacing, int dimension) {
  return dimension == 2 ? spacing * spacing : spacing * spacing * spacing;
}

double estimate_count(const Shape& shape, double spacing, int dimension) {
  require_fillable(shape, spacing, dimension);
  const Box box = shape.bounds();
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    if (box.lower[a] >= box.upper[a]) return 0.0;
  }
  constexpr int halvings = 21;  // at the surface 1448 x 1448 cells in 2D, 128^3 in 3D
  return volume_within(shape, box, dimension, halvings, 0.25 * spacing) / lattice_volume(spacing, dimension);
}

std::vector<Point> fill_lattice(const Shape& shape, double spacing, int dimension,
                                const LatticeOptions& options) {
  require_fillable(shape, spacing, dimension);
  const Box box = shape.bounds();
  double most = 1.0;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
    most *= std::max(0.0, box.upper[a] - box.lower[a]) / spacing;
  }
  if (most > static_cast<double>(options.limit)) {
    const double estimate = estimate_count(shape, spacing, dimension);
    // It may be a few percent off; what it lets pass is still counted while the points are made.
    if (estimate > 1.1 * static_cast<double>(options.limit)) {
      refuse_count(about(estimate, "particles"), box, spacing, options.limit);
    }
  }
  const Steps steps(spacing, dimension, options.kind);
  const double reach_y = 0.25 * steps.step[1];  // rows may be shifted out of their cell
  const Range rows =
      range_of(box.lower[1] - reach_y, box.upper[1] + reach_y, options.origin[1], steps.step[1]);
  const Range layers =
      dimension == 3 ? range_of(box.lower[2], box.upper[2], options.origin[2], steps.step[2]) : Range{0, 0};
  const double row_count =
      static_cast<double>(rows.last - rows.first + 1) * static_cast<double>(layers.last - layers.first + 1);
  if (row_count > 16.0 * static_cast<double>(options.limit) + 1e6) {
    refuse_count(about(row_count, "lattice rows to be searched"), box, spacing, options.limit);
  }
  RowFiller filler(shape, spacing, options, steps);
  for (std::int64_t k = layers.first; k <= layers.last; ++k) {
    for (std::int64_t j = rows.first; j <= rows.last; ++j) filler.row(j, k);
  }
  return filler.take();
}

}  // namespace shoal::kernel
