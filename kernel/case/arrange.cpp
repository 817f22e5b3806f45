// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/case/arrange.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernel/case/shapes.hpp"
#include "kernel/geometry/cell_grid.hpp"
#include "kernel/geometry/generator.hpp"
#include "kernel/geometry/relax.hpp"
#include "kernel/particles/errors.hpp"
#include "kernel/plugins/host.hpp"

namespace shoal::kernel {
namespace {

struct BodyParticles {
  const BodyModel* model;
  ShapePtr shape;
  std::vector<Point> points;
};

PeriodicBox periodic_box(const CaseModel& model) {
  PeriodicBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.periodic[k] = model.domain.periodic[k];
    box.lower[k] = std::isfinite(model.domain.lower[k]) ? model.domain.lower[k] : 0.0;
    box.upper[k] = std::isfinite(model.domain.upper[k]) ? model.domain.upper[k] : 0.0;
  }
  return box;
}

// A shape may reach through a periodic face, so that its surface does not end there; its particles do.
void cut_at_periodic_faces(std::vector<Point>& points, const PeriodicBox& box) {
  std::erase_if(points, [&](const Point& point) {
    for (std::size_t k = 0; k < 3; ++k)
      if (box.periodic[k] && (point[k] < box.lower[k] || point[k] >= box.upper[k])) return true;
    return false;
  });
}

BodyParticles fill(const BodyModel& body, const PeriodicBox& box, int dimensions) {
  BodyParticles result{&body, make_shape(*body.shape, dimensions), {}};
  LatticeOptions options;
  options.kind = body.arrangement == "hexagonal" ? Lattice::hexagonal : Lattice::cubic;
  const Box bounds = result.shape->bounds();
  for (std::size_t k = 0; k < 3; ++k)
    options.origin[k] = std::isfinite(bounds.lower[k]) ? bounds.lower[k] : 0.0;
  try {
    result.points = fill_lattice(*result.shape, body.resolution, dimensions, options);
  } catch (const std::logic_error& error) {  // invalid_argument, length_error
    throw ModelError("body '" + body.name + "': " + error.what(), body.place);
  }
  cut_at_periodic_faces(result.points, box);
  if (result.points.empty())
    throw ModelError(
        "body '" + body.name + "' holds no particle: its shape is empty, or thinner than its resolution",
        body.place);
  return result;
}

// Also through periodic faces: shapes themselves do not repeat.
bool near_shape(const Shape& shape, const Point& point, double distance, const PeriodicBox& box,
                int dimensions) {
  if (shape.signed_distance(point) < distance) return true;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k) {
    if (!box.periodic[k]) continue;
    for (const double sign : {-1.0, 1.0}) {
      Point image = point;
      image[k] += sign * (box.upper[k] - box.lower[k]);
      if (shape.signed_distance(image) < distance) return true;
    }
  }
  return false;
}

void leave_out_overlap(BodyParticles& later, const BodyParticles& earlier, const PeriodicBox& box,
                       int dimensions) {
  // Lattices of bodies that touch are a spacing apart; rounding must not make that an overlap.
  const double distance = 0.5 * std::min(later.model->resolution, earlier.model->resolution) * (1.0 - 1e-6);
  std::vector<std::size_t> suspects;
  for (std::size_t i = 0; i < later.points.size(); ++i)
    if (near_shape(*earlier.shape, later.points[i], distance, box, dimensions)) suspects.push_back(i);
  if (suspects.empty()) return;
  std::vector<Point> wrapped = earlier.points;
  for (Point& point : wrapped) point = box.wrapped(point);
  const CellGrid grid(wrapped, box, distance, dimensions);
  std::vector<bool> left_out(later.points.size(), false);
  std::size_t n = 0;
  for (const std::size_t i : suspects) {
    const Point at = box.wrapped(later.points[i]);
    bool taken = false;
    grid.near(at, [&](std::size_t j) {
      taken = taken || point::length(box.shortest(point::minus(at, wrapped[j]))) < distance;
    });
    left_out[i] = taken;
    n += taken ? 1 : 0;
  }
  if (n == 0) return;
  const std::string what = "'" + later.model->name + "' overlaps '" + earlier.model->name + "'";
  if (n == later.points.size())
    throw ModelError("body " + what + " everywhere: no particle of it is left", later.model->place);
  log(LogLevel::warning, later.model->place + ": body " + what + ", which comes first: " + std::to_string(n) +
                             " of its " + std::to_string(later.points.size()) + " particles are left out");
  std::vector<Point> kept;
  for (std::size_t i = 0; i < later.points.size(); ++i)
    if (!left_out[i]) kept.push_back(later.points[i]);
  later.points = std::move(kept);
}

void relax_body(std::size_t index, std::vector<BodyParticles>& bodies, const PeriodicBox& box,
                int dimensions) {
  BodyParticles& body = bodies[index];
  RelaxParameters parameters;
  parameters.dimension = dimensions;
  parameters.spacing = body.model->resolution;
  parameters.domain = box;
  parameters.shape = body.shape;
  for (std::size_t other = 0; other < bodies.size(); ++other) {
    const bool same = std::abs(bodies[other].model->resolution / body.model->resolution - 1.0) < 1e-9;
    if (other == index || !same) continue;
    const double reach = 3.0 * body.model->resolution;
    for (const Point& point : bodies[other].points)
      if (near_shape(*body.shape, point, reach, box, dimensions))
        parameters.fixed.push_back(box.wrapped(point));
  }
  for (Point& point : body.points) point = box.wrapped(point);
  try {
    relax(body.points, parameters);
  } catch (const std::invalid_argument& error) {
    throw ModelError("body '" + body.model->name + "' cannot be relaxed: " + error.what(), body.model->place);
  }
}

}  // namespace

std::vector<std::vector<Point>> arrange_particles(const CaseModel& model, bool skip_relaxation) {
  const PeriodicBox box = periodic_box(model);
  std::vector<BodyParticles> bodies;
  for (const BodyModel& body : model.bodies) {
    BodyParticles particles = fill(body, box, model.dimensions);
    for (const BodyParticles& earlier : bodies) leave_out_overlap(particles, earlier, box, model.dimensions);
    bodies.push_back(std::move(particles));
  }
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (bodies[k].model->arrangement == "relaxed" && !skip_relaxation)
      relax_body(k, bodies, box, model.dimensions);
  std::vector<std::vector<Point>> points;
  for (BodyParticles& body : bodies) points.push_back(std::move(body.points));
  return points;
}

}  // namespace shoal::kernel
