// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Random displacement and shifting sweeps.
#include "relax.hpp"

#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "generator.hpp"
#include "medium.hpp"

namespace shoal::kernel {
namespace {

constexpr double largest_shift = 0.1;       // of a sweep, in spacings
constexpr double list_margin = 0.4;         // the pair list reaches so much further than needed, in spacings
constexpr double outside_tolerance = 1e-6;  // as in fill_lattice, in spacings

/// Wendland C2: W = alpha (1 - q/2)^4 (2q + 1), q = r / h < 2.
struct Wendland {
  double h;
  double alpha;

  Wendland(double smoothing_length, int dimension)
      : h(smoothing_length),
        alpha(dimension == 2 ? 7.0 / (4.0 * std::numbers::pi * h * h)
                             : 21.0 / (16.0 * std::numbers::pi * h * h * h)) {}

  [[nodiscard]] double value(double r) const {
    const double t = std::max(0.0, 1.0 - 0.5 * r / h);
    return alpha * t * t * t * t * (2.0 * r / h + 1.0);
  }
  /// W'(r) / r, finite at r = 0.
  [[nodiscard]] double slope_over_r(double r) const {
    const double t = std::max(0.0, 1.0 - 0.5 * r / h);
    return -5.0 * alpha / (h * h) * t * t * t;
  }
};

/// SplitMix64 as a hash: the stream of a particle and axis needs no state and no order.
double random_sign_and_size(std::uint64_t seed, std::uint64_t counter) {
  std::uint64_t z = seed * 0x9e3779b97f4a7c15ULL + (counter + 1) * 0xd1342543de82ef95ULL;
  for (int round = 0; round < 2; ++round) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
  }
  return 2.0 * static_cast<double>(z >> 11) * 0x1.0p-53 - 1.0;
}

void validate(const std::vector<Point>& points, const RelaxParameters& parameters) {
  std::ostringstream out;
  const double cut_off = 2.0 * parameters.smoothing * parameters.spacing;
  if (parameters.dimension != 2 && parameters.dimension != 3) {
    out << "particles relax in 2 or 3 dimensions, not " << parameters.dimension;
  } else if (!(std::isfinite(parameters.spacing) && parameters.spacing > 0.0)) {
    out << "the particle spacing must be positive, but is " << parameters.spacing;
  } else if (!(parameters.smoothing >= 1.0 && parameters.smoothing <= 4.0)) {
    out << "the smoothing length must be 1 to 4 spacings, but is " << parameters.smoothing;
  } else if (!(parameters.displacement >= 0.0 && parameters.displacement <= 0.5)) {
    out << "the random displacement must be 0 to 0.5 spacings, but is " << parameters.displacement;
  } else if (parameters.sweeps < 0 || !(parameters.tolerance >= 0.0)) {
    out << "neither the number of sweeps nor the tolerance may be negative";
  } else if (points.size() >= std::numeric_limits<std::uint32_t>::max()) {
    out << "at most 4294967294 particles can be relaxed at once";
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(parameters.dimension) && out.str().empty(); ++a) {
    const double length = parameters.domain.upper[a] - parameters.domain.lower[a];
    if (!parameters.domain.periodic[a]) {
      if (!parameters.shape)
        out << "along "
            << "xyz"[a] << " there is neither a period nor a shape to keep particles in";
    } else if (!(std::isfinite(length) && length >= 2.0 * cut_off)) {
      out << "the period along "
          << "xyz"[a] << " is " << length << ", but must be at least two cut-offs, " << 2.0 * cut_off;
    }
  }
  if (!out.str().empty()) throw std::invalid_argument(out.str());
}

class Relaxation {
 public:
  Relaxation(std::vector<Point>& points, const RelaxParameters& parameters)
      : points_(points),
        parameters_(parameters),
        kernel_(parameters.smoothing * parameters.spacing, parameters.dimension),
        cut_off_(2.0 * kernel_.h),
        volume_(particle_volume()),
        medium_(sample_medium()),
        medium_grid_(medium_.places, parameters.domain, cut_off_, parameters.dimension) {
    require_inside();
    list_pairs();
  }

  void displace() {
    const double size = parameters_.displacement * parameters_.spacing;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Point to = points_[i];
      for (std::size_t a = 0; a < static_cast<std::size_t>(parameters_.dimension); ++a) {
        to[a] += size * random_sign_and_size(parameters_.seed, 3 * i + a);
      }
      points_[i] = kept_inside(points_[i], to);
    }
    list_pairs();
  }

  /// One shift of every particle; returns the largest, in spacings.
  double sweep() {
    std::vector<Point> gradient(points_.size(), Point{});
    add_pairs(gradient);
    add_medium(gradient);
    const double cap = largest_shift * parameters_.spacing;
    double largest = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point wanted = point::times(-0.5 * kernel_.h * kernel_.h, gradient[i]);
      const double size = point::length(wanted);
      const Point shift = point::times(size > cap ? cap / size : 1.0, wanted);
      points_[i] = kept_inside(points_[i], point::plus(points_[i], shift));
      largest = std::max(largest, std::min(size, cap));
    }
    // Every particle may have come closer to another by twice the largest shift.
    list_is_good_for_ -= 2.0 * largest;
    if (list_is_good_for_ < 0.0) list_pairs();
    return largest / parameters_.spacing;
  }

  [[nodiscard]] Uniformity uniformity() const {
    std::vector<double> sum(points_.size(), volume_ * kernel_.value(0.0));
    Uniformity result;
    result.closest_pair = infinity;
    for_pairs([&](std::size_t i, std::size_t j, const Point& apart) {
      const double r = point::length(apart);
      const double w = volume_ * kernel_.value(r);
      sum[i] += w;
      sum[j] += w;
      result.closest_pair = std::min(result.closest_pair, r / parameters_.spacing);
    });
    for_medium([&](std::size_t i, const Point& apart, double volume) {
      sum[i] += volume * kernel_.value(point::length(apart));
    });
    for (const double s : sum) {
      const double error = s - 1.0;
      result.mean += error;
      result.rms += error * error;
      result.largest = std::max(result.largest, std::abs(error));
    }
    const double count = std::max(1.0, static_cast<double>(points_.size()));
    result.mean /= count;
    result.rms = std::sqrt(result.rms / count);
    for (const double s : sum) result.spread += (s - 1.0 - result.mean) * (s - 1.0 - result.mean);
    result.spread = std::sqrt(result.spread / count);
    return result;
  }

 private:
  /// In a periodic box the share of its volume, so that the sum is one on average; else that of a lattice
  /// cell.
  [[nodiscard]] double particle_volume() const {
    const double cell = lattice_volume(parameters_.spacing, parameters_.dimension);
    if (parameters_.shape || points_.empty() || !parameters_.fixed.empty()) return cell;
    double volume = 1.0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(parameters_.dimension); ++a) {
      volume *= parameters_.domain.upper[a] - parameters_.domain.lower[a];
    }
    return volume / static_cast<double>(points_.size());
  }

  [[nodiscard]] Medium sample_medium() const {
    Medium medium;
    if (parameters_.shape && !points_.empty()) {
      medium = sample_medium_outside(parameters_, extents(), cut_off_);
    }
    medium.give_way(parameters_.fixed, parameters_);
    return medium;
  }

  /// Of the points and of the shape where it ends: particles may settle anywhere inside.
  [[nodiscard]] Box extents() const {
    Box around{points_.front(), points_.front()};
    for (const Point& p : points_) {
      for (std::size_t a = 0; a < 3; ++a) {
        around.lower[a] = std::min(around.lower[a], p[a]);
        around.upper[a] = std::max(around.upper[a], p[a]);
      }
    }

    const Box shape = parameters_.shape->bounds();
    for (std::size_t a = 0; a < 3; ++a) {
      if (std::isfinite(shape.lower[a])) around.lower[a] = std::min(around.lower[a], shape.lower[a]);
      if (std::isfinite(shape.upper[a])) around.upper[a] = std::max(around.upper[a], shape.upper[a]);
    }
    return around;
  }

  void require_inside() const {
    const double tolerance = outside_tolerance * parameters_.spacing;
    for (const Point& p : points_) {
      bool inside =
          point::finite(p) && (!parameters_.shape || parameters_.shape->signed_distance(p) <= tolerance);
      for (std::size_t a = 0; a < 3; ++a) {
        if (!parameters_.domain.periodic[a]) continue;
        inside = inside && p[a] >= parameters_.domain.lower[a] && p[a] < parameters_.domain.upper[a];
      }
      if (inside) continue;
      std::ostringstream out;
      out << "the particle at (" << p[0] << ", " << p[1] << ", " << p[2]
          << ") lies outside the shape or the periodic "
          << "domain in which it should relax";
      throw std::invalid_argument(out.str());
    }
  }

  /// Where a particle comes to that wants from `from` to `to`: mirrored at the surface if it would cross it,
  /// and not moved at all where that leads outside again (in a sharp corner).
  [[nodiscard]] Point kept_inside(const Point& from, Point to) const {
    to = parameters_.domain.wrapped(to);
    if (!parameters_.shape) return to;
    const double beyond = parameters_.shape->signed_distance(to);
    if (beyond <= 0.0) return to;
    to = parameters_.domain.wrapped(point::along(to, -2.0 * beyond, parameters_.shape->normal(to)));
    return parameters_.shape->signed_distance(to) <= 0.0 ? to : from;
  }

  void list_pairs() {
    const double margin = list_margin * parameters_.spacing;
    const double reach = cut_off_ + margin;
    const CellGrid grid(points_, parameters_.domain, reach, parameters_.dimension);
    row_.assign(1, 0);
    row_.reserve(points_.size() + 1);
    other_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      grid.near(points_[i], [&](std::uint32_t j) {
        if (j <= i) return;
        const Point apart = parameters_.domain.shortest(point::minus(points_[i], points_[j]));
        if (point::dot(apart, apart) < reach * reach) other_.push_back(j);
      });
      row_.push_back(other_.size());
    }
    list_is_good_for_ = margin;
  }

  /// Each pair once.
  template <class Visit>
  void for_pairs(Visit&& visit) const {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (std::size_t s = row_[i]; s < row_[i + 1]; ++s) {
        const Point apart = parameters_.domain.shortest(point::minus(points_[i], points_[other_[s]]));
        if (point::dot(apart, apart) < cut_off_ * cut_off_) visit(i, other_[s], apart);
      }
    }
  }

  template <class Visit>
  void for_medium(Visit&& visit) const {
    if (medium_.places.empty()) return;
    const double reach = cut_off_ + parameters_.spacing;
    const bool only_outside = parameters_.shape && parameters_.fixed.empty();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (only_outside && parameters_.shape->signed_distance(points_[i]) < -reach) continue;
      medium_grid_.near(points_[i], [&](std::uint32_t m) {
        const Point apart = parameters_.domain.shortest(point::minus(points_[i], medium_.places[m]));
        if (point::dot(apart, apart) < cut_off_ * cut_off_) visit(i, apart, medium_.volumes[m]);
      });
    }
  }

  void add_pairs(std::vector<Point>& gradient) const {
    for_pairs([&](std::size_t i, std::size_t j, const Point& apart) {
      const double slope = volume_ * kernel_.slope_over_r(point::length(apart));
      gradient[i] = point::along(gradient[i], slope, apart);
      gradient[j] = point::along(gradient[j], -slope, apart);
    });
  }

  void add_medium(std::vector<Point>& gradient) const {
    for_medium([&](std::size_t i, const Point& apart, double volume) {
      gradient[i] = point::along(gradient[i], volume * kernel_.slope_over_r(point::length(apart)), apart);
    });
  }

  std::vector<Point>& points_;
  const RelaxParameters& parameters_;
  Wendland kernel_;
  double cut_off_;
  double volume_;
  Medium medium_;
  CellGrid medium_grid_;
  std::vector<std::size_t> row_;
  std::vector<std::uint32_t> other_;
  double list_is_good_for_ = 0.0;
};

}  // namespace

RelaxReport relax(std::vector<Point>& points, const RelaxParameters& parameters) {
  validate(points, parameters);
  Relaxation relaxation(points, parameters);
  RelaxReport report;
  relaxation.displace();
  report.displaced = relaxation.uniformity();
  while (report.sweeps < parameters.sweeps && !report.converged) {
    report.largest_move = relaxation.sweep();
    ++report.sweeps;
    report.converged = report.largest_move <= parameters.tolerance;
  }
  report.relaxed = relaxation.uniformity();
  return report;
}

Uniformity measure_uniformity(const std::vector<Point>& points, const RelaxParameters& parameters) {
  validate(points, parameters);
  std::vector<Point> copy = points;
  return Relaxation(copy, parameters).uniformity();
}

}  // namespace shoal::kernel
