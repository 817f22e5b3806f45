// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Guards: the fast pass and the report.
#include "kernel/schedule/health.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>

#include "kernel/particles/parallel.hpp"

namespace shoal::kernel {

namespace {

constexpr double largest = std::numeric_limits<double>::max();
constexpr std::size_t n_worst = 5;

// Eight particles at a time against a pattern of bounds, so that the inner loop has a constant length and no branch.
template <std::size_t Components>
bool all_inside(const double* values, std::uint64_t n, const double* minimum, const double* maximum) {
  constexpr std::size_t width = SHOAL_PADDING * Components;
  std::array<double, width> low, high;
  for (std::size_t k = 0; k < width; ++k) {
    low[k] = minimum[k % Components];
    high[k] = maximum[k % Components];
  }
  std::array<std::uint64_t, width> outside{};
  const std::uint64_t end = n * Components;
  std::uint64_t begin = 0;
  for (; begin + width <= end; begin += width)
    for (std::size_t k = 0; k < width; ++k) {
      const double value = values[begin + k];
      outside[k] |=
          static_cast<std::uint64_t>(!(value >= low[k])) | static_cast<std::uint64_t>(!(value <= high[k]));
    }
  std::uint64_t any = 0;
  for (std::size_t k = 0; k < width; ++k) any |= outside[k];
  for (std::size_t k = 0; begin + k < end; ++k)
    any |= static_cast<std::uint64_t>(!(values[begin + k] >= low[k] && values[begin + k] <= high[k]));
  return any == 0;
}

bool all_inside(std::uint32_t components, const double* values, std::uint64_t n, const double* minimum,
                const double* maximum) {
  switch (components) {
    case 1: return all_inside<1>(values, n, minimum, maximum);
    case 2: return all_inside<2>(values, n, minimum, maximum);
    case 3: return all_inside<3>(values, n, minimum, maximum);
    case 4: return all_inside<4>(values, n, minimum, maximum);
    case 6: return all_inside<6>(values, n, minimum, maximum);
    default: return all_inside<9>(values, n, minimum, maximum);
  }
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

void Health::watch(const Domain& domain, std::vector<std::unique_ptr<Body>>& bodies) {
  const auto d = static_cast<std::size_t>(domain.dimensions);
  std::array<double, 3> low{largest, largest, largest}, high{-largest, -largest, -largest};
  double reach = 0.0;
  for (const auto& body : bodies) {
    reach = std::max(reach, body->cutoff);
    const double* position = body->position().reals();
    for (std::uint64_t k = 0; k < body->n_owned() * d; ++k) {
      low[k % d] = std::min(low[k % d], position[k]);
      high[k % d] = std::max(high[k % d], position[k]);
    }
  }
  double extent = reach;
  for (std::size_t a = 0; a < d; ++a) extent = std::max(extent, high[a] - low[a]);
  std::vector<double> minimum(d), maximum(d);
  for (std::size_t a = 0; a < d; ++a) {
    const int axis = static_cast<int>(a);
    // A thin layer of particles may leave its plane by as much as the others have room.
    const double room = high[a] - low[a] > reach ? high[a] - low[a] : extent;
    minimum[a] = std::isfinite(domain.lower[axis]) ? domain.lower[axis] : low[a] - room;
    maximum[a] = std::isfinite(domain.upper[axis]) ? domain.upper[axis] : high[a] + room;
    // Between two renewals particles may be beyond a periodic face, and always somewhat beyond a mirror plane.
    if (domain.periodic(axis)) minimum[a] -= domain.length(axis), maximum[a] += domain.length(axis);
    if (domain.boundary[axis].lower == BoundaryKind::mirror) minimum[a] -= reach;
    if (domain.boundary[axis].upper == BoundaryKind::mirror) maximum[a] += reach;
  }
  for (const auto& body : bodies) {
    guards_.push_back({body.get(), &body->position(), minimum, maximum, Guard::Kind::position});
    if (Field* velocity = body->find("velocity"))
      guards_.push_back({body.get(), velocity, std::vector<double>(d, -largest),
                         std::vector<double>(d, largest), Guard::Kind::finite});
  }
}

void Health::guard(Body& body, Field& field, double minimum, double maximum) {
  const std::size_t n = field.components();
  guards_.push_back({&body, &field, std::vector<double>(n, std::max(minimum, -largest)),
                     std::vector<double>(n, std::min(maximum, largest)), Guard::Kind::range});
}

bool Health::holds(Guard& guard) {
  if (guard.held_at == guard.field->changes) return true;
  std::atomic<bool> inside = true;
  const std::uint32_t components = guard.field->components();
  const double* values = guard.field->reals();
  for_each_range(guard.body->n_owned(), [&](std::uint64_t begin, std::uint64_t end) {
    if (!all_inside(components, values + begin * components, end - begin, guard.minimum.data(),
                    guard.maximum.data()))
      inside.store(false, std::memory_order_relaxed);
  });
  if (inside.load()) guard.held_at = guard.field->changes;
  return inside.load();
}

PhysicsFailure::Particle describe_particle(const Body& body, std::uint64_t index, const std::string& field,
                                           double value) {
  PhysicsFailure::Particle particle;
  particle.id = body.ids().integers()[index];
  particle.body = body.name();
  particle.index = index;
  const auto d = static_cast<std::uint64_t>(body.dimensions());
  for (std::uint64_t a = 0; a < d; ++a) particle.position[a] = body.position().reals()[index * d + a];
  particle.field = field;
  particle.value = value;
  return particle;
}

void Health::fail(const Guard& guard, const Whereabouts& where) {
  struct Offence {
    double excess;
    std::uint64_t index;
    double value;
  };
  std::vector<Offence> worst;
  std::uint64_t count = 0, not_finite = 0;
  const std::uint32_t components = guard.field->components();
  for (std::uint64_t i = 0; i < guard.body->n_owned(); ++i) {
    Offence offence{0.0, i, 0.0};
    for (std::uint32_t c = 0; c < components; ++c) {
      const double value = guard.field->reals()[i * components + c];
      const double excess = std::isfinite(value)
                                ? std::max(guard.minimum[c] - value, value - guard.maximum[c])
                                : std::numeric_limits<double>::infinity();
      if (excess > offence.excess) offence = {excess, i, value};
    }
    if (!(offence.excess > 0.0)) continue;
    ++count;
    not_finite += std::isinf(offence.excess) ? 1 : 0;
    worst.push_back(offence);
    std::stable_sort(worst.begin(), worst.end(),
                     [](const Offence& a, const Offence& b) { return a.excess > b.excess; });
    if (worst.size() > n_worst) worst.pop_back();
  }
  const std::string of_body = " of body '" + guard.body->name() + "'";
  const std::string particles = std::to_string(count) + (count == 1 ? " particle" : " particles");
  PhysicsFailure::Report report;
  if (not_finite > 0)
    report.cause = "field '" + guard.field->name() + "'" + of_body + " is not a finite number at " +
                   std::to_string(not_finite) + (not_finite == 1 ? " particle" : " particles");
  else if (guard.kind == Guard::Kind::position)
    report.cause = particles + of_body + (count == 1 ? " has" : " have") + " left the domain";
  else
    report.cause = "field '" + guard.field->name() + "'" + of_body + " is outside [" +
                   number(guard.minimum[0]) + ", " + number(guard.maximum[0]) + "] at " + particles;
  report.loop = where.loop;
  report.step = where.step;
  report.time = where.time;
  for (const Offence& offence : worst)
    report.worst.push_back(describe_particle(*guard.body, offence.index, guard.field->name(), offence.value));
  throw PhysicsFailure(std::move(report));
}

void Health::check(const Whereabouts& where) {
  for (Guard& guard : guards_)
    if (!holds(guard)) fail(guard, where);
}

void Health::check_positions(const Whereabouts& where) {
  for (Guard& guard : guards_)
    if (guard.kind == Guard::Kind::position && guard.body->position_changed && !holds(guard))
      fail(guard, where);
}

}  // namespace shoal::kernel
