// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "inflow.hpp"
#include "outflow.hpp"

namespace shoal::fluid {
namespace {

constexpr At at_initial{SHOAL_INITIAL, "zones"};
constexpr At at_shift{"advection", "zone_shift"};
constexpr At at_density{"advection", "zone_density"};
constexpr At at_state{"acoustic", "zone_state"};
constexpr At at_motion{"acoustic", "zone_motion"};
constexpr At at_sample{SHOAL_SAMPLE, "crossed_mass"};

// A number for a zone that is the same whenever the case is run: FNV-1a of where it is (Fowler, Noll, Vo).
std::int64_t name_of(const Zone& zone) {
  std::uint64_t hash = 14695981039346656037u;
  for (const auto* vector : {&zone.origin, &zone.normal, &zone.lower, &zone.upper})
    for (const double value : *vector) {
      unsigned char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
    }
  return static_cast<std::int64_t>(hash >> 2) + 1;
}

// The stages of fluid.wcsph between which those of the zones lie; whichever is built first.
void declare_stages(const Builder& b) {
  b.loop("advection",
         {"shift", "zone_shift", "apply_shift", "density", "zone_density", "geometry", "filter"});
  b.loop("acoustic", {"advection", "acoustic"},
         {"predict", "zone_state", "momentum", "kick", "zone_motion", "continuity"});
}

EquationOfState equation_of_state(const Builder& b, BodyIndex body) {
  const auto eos = b.material_interface<shoal_equation_of_state>(body, SHOAL_EQUATION_OF_STATE,
                                                                 SHOAL_EQUATION_OF_STATE_REVISION);
  if (!eos)
    throw CaseError(
        std::string("body '") + b.body(body).name +
        "' needs a material with an equation of state, e.g. material: {fluid.liquid: {density: 1000}}");
  return eos;
}

template <class Name>
void attach_crossed_mass(const Builder& b, BodyIndex body, const MassPointer& mass, const char* name) {
  b.own_field(body, Name::field, at_sample);
  b.attach<CrossedMass<Name>>(
      name, at_sample, b.target(body), [&](auto& op) { op.crossed = mass; }, SHOAL_OPERATOR_ON_DEMAND);
}

}  // namespace

ZonePointer PlaneParameters::zone(const Builder& b, BodyIndex body, bool has_length) const {
  auto zone = std::make_shared<Zone>();
  const auto d = static_cast<std::size_t>(b.dimensions());
  zone->origin = at.value();
  const Vector3 n = normal;
  const double magnitude = std::hypot(n[0], n[1], n[2]);
  if (magnitude == 0.0) throw CaseError(normal.place() + ": the normal has no length");
  for (std::size_t a = 0; a < d; ++a) {
    zone->normal[a] = n[a] / magnitude;
    zone->lower[a] = lower.is_set() ? lower.value()[a] : -std::numeric_limits<double>::infinity();
    zone->upper[a] = upper.is_set() ? upper.value()[a] : std::numeric_limits<double>::infinity();
    if (!(zone->lower[a] < zone->upper[a]))
      throw CaseError(upper.place() + ": upper must be beyond lower along each axis");
  }
  const Target target = b.target(body);
  // Twice the cut-off: then the particles that the fluid sees have whole supports themselves.
  if (has_length)
    zone->length = length.is_set() ? static_cast<double>(length)
                                   : std::ceil(2.0 * target.cutoff / target.spacing - 1e-6) * target.spacing;
  if (has_length && zone->length < target.cutoff)
    throw CaseError(length.place() + ": the zone must be at least as long as the cut-off, " +
                    std::to_string(target.cutoff) + " m");
  zone->name = name_of(*zone);
  return zone;
}

void InflowPhysics::build(const Builder& b) {
  declare_stages(b);
  for (const BodyIndex body : bodies.value()) {
    const ZonePointer where = zone(b, body, true);
    const EquationOfState eos = equation_of_state(b, body);
    const auto mass = std::make_shared<double>(0.0);
    const auto in_zone = [&](auto& op) {
      op.zone = where;
      if constexpr (requires { op.equation_of_state; }) op.equation_of_state = eos;
      if constexpr (requires { op.crossed; }) op.crossed = mass;
      if constexpr (requires { op.profile; }) op.profile = velocity;
    };
    b.attach<FillZone>("fluid.inflow.fill", at_initial, b.target(body), in_zone);
    b.attach<Inflow>("fluid.inflow", at_shift, b.target(body), in_zone);
    b.attach<ZoneShift>("fluid.inflow.shift", at_shift, b.target(body), in_zone);
    b.attach<ZoneDensity>("fluid.inflow.density", at_density, b.target(body), in_zone);
    b.attach<ZonePressure>("fluid.inflow.pressure", at_state, b.target(body, {body}), in_zone,
                           SHOAL_OPERATOR_SERIAL);
    b.attach<InflowVelocity>("fluid.inflow.velocity", at_motion, b.target(body), in_zone);
    attach_crossed_mass<EnteredMass>(b, body, mass, "fluid.inflow.entered_mass");
  }
}

void OutflowPhysics::build(const Builder& b) {
  declare_stages(b);
  const bool is_free = condition.value() == "free", absorbs = condition.value() == "non_reflecting";
  if (absorbs != averaging_time.is_set())
    throw CaseError(condition.place() +
                    ": fluid.outflow takes averaging_time with condition: non_reflecting, and only then");
  for (const BodyIndex body : bodies.value()) {
    const ZonePointer where = zone(b, body, !is_free);
    const auto mass = std::make_shared<double>(0.0);
    const auto impedance = std::make_shared<Impedance>();
    impedance->time = absorbs ? static_cast<double>(averaging_time) : 0.0;
    const EquationOfState eos = equation_of_state(b, body);
    const auto in_zone = [&](auto& op) {
      op.zone = where;
      if constexpr (requires { op.equation_of_state; }) op.equation_of_state = eos;
      if constexpr (requires { op.crossed; }) op.crossed = mass;
      if constexpr (requires { op.impedance; }) op.impedance = impedance;
      if constexpr (requires { op.boundary_pressure; }) op.boundary_pressure = pressure;
    };
    b.attach<Outflow>("fluid.outflow", at_shift, b.target(body), in_zone);
    attach_crossed_mass<LeftMass>(b, body, mass, "fluid.outflow.left_mass");
    if (is_free) continue;
    b.attach<FillZone>("fluid.outflow.fill", at_initial, b.target(body), in_zone);
    b.attach<ZoneShift>("fluid.outflow.shift", at_shift, b.target(body), in_zone);
    b.attach<ZoneDensity>("fluid.outflow.density", at_density, b.target(body), in_zone);
    b.attach<OutflowState>("fluid.outflow.pressure", at_state, b.target(body), in_zone);
    b.attach<OutflowVelocity>("fluid.outflow.velocity", at_motion, b.target(body, {body}), in_zone,
                              SHOAL_OPERATOR_SERIAL);
  }
}

}  // namespace shoal::fluid
