// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the operators of one solid body share.
#pragma once

#include <memory>

#include "pressure_grid.hpp"
#include "reference_weights.hpp"
#include "shoal/interfaces/stress_law.h"
#include "shoal/physics.hpp"

namespace shoal::solid {

using StressLaw = Interface<shoal_stress_law>;

struct Structure {
  StressLaw law;
  shoal_elastic_constants constants{};
  std::uint32_t kinematics = SHOAL_THREE_DIMENSIONAL;
  ReferenceSettings settings;
  bool end_correction = false;
  double hourglass = 0;   // modulus of the hourglass control, Pa
  double wave_speed = 0;  // m/s, the largest when last looked at; 0 for laws that do not stiffen
  ReferenceWeights weights;
  PressureGrid grid;  // of nearly incompressible materials
  HeldRegions held;   // shapes that the body is built into

  HeldSurface held_surface(int dimensions, std::uint64_t n, const double* reference_position) const {
    HeldSurface surface;
    if (held) surface.look(*held, dimensions, n, reference_position, settings.spacing);
    return surface;
  }

  Stiffness stiffness() const {
    // The modulus of longitudinal waves is lambda + 2 mu; in plane stress that of a plate.
    const double rho = constants.density, mu = constants.shear_modulus;
    return {rho * constants.longitudinal_speed * constants.longitudinal_speed - 2.0 * mu,
            mu,
            hourglass,
            rho,
            nullptr,
            0.0};
  }
  // With the pressure on its grid, once there is one.
  Stiffness stiffness_on_grid() const {
    Stiffness known = stiffness();
    if (grid.built()) known.grid = &grid, known.bulk = constants.bulk_modulus;
    return known;
  }
};
using SharedStructure = std::shared_ptr<Structure>;

// The reference neighbourhood of the scheme: its radius is chosen by the physics, whatever the body's smoothing length.
inline Target reference_target(const Builder& builder, BodyIndex body, const Structure& structure) {
  Target target = builder.target(body);
  target.smoothing_kernel = SmoothingKernel::wendland_c2;
  target.smoothing_length = structure.settings.smoothing_length;
  target.cutoff = 2.0 * structure.settings.smoothing_length;
  target.configuration = SHOAL_REFERENCE;
  return target;
}

// Operators over pairs of the reference configuration with stored weights.
class ReferenceOperator : public OperatorBase {
 public:
  static constexpr bool pairs = true;
  SharedStructure structure;

 protected:
  ReferenceOperator() : OperatorBase(true) {}
};

// One that may be the first to need the weights, and then makes them.
class WeightBuilder : public ReferenceOperator {
 protected:
  void build_weights() const {
    if (structure->weights.built()) return;
    const HeldSurface held = structure->held_surface(dimensions(), n_particles(), reference_position.data());
    structure->weights.build(dimensions(), structure->settings, neighbours(0),
                             {reference_position.data(), volume.data(), normal.data(), distance.data(),
                              held.empty() ? nullptr : &held});
  }

  In<Vector> reference_position{"reference_position", own_only};
  In<Scalar> volume{"volume", own_only};
  In<Vector> normal{"normal", own_only};
  In<Scalar> distance{"signed_distance", own_only};
};

// Makes the weights before anything asks for a step, so that what is wrong with the body is said in time.
struct InitialWeights : WeightBuilder {
  void begin() { build_weights(); }
  template <int D>
  void run_chunk(const shoal_chunk&) const {}
};

}  // namespace shoal::solid
