// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The fields that plugins of different areas share, with one meaning each. An operator that names one of them need
// not (and cannot) say its rank and unit again. Fields of one plugin alone are declared where they are used.
// In two dimensions extensive quantities (mass, volume, force) are per metre of depth.
#pragma once

#include <array>
#include <string_view>

#include "shoal/abi.h"

namespace shoal {

struct SharedField {
  std::string_view name;
  shoal_rank rank;
  std::string_view unit;  // UDUNITS-2
  std::string_view doc;
};

inline constexpr std::array shared_fields{
    SharedField{"position", SHOAL_RANK_VECTOR, "m", "Current position."},
    SharedField{"reference_position", SHOAL_RANK_VECTOR, "m", "Position in the reference configuration."},
    SharedField{"displacement", SHOAL_RANK_VECTOR, "m", "Position less reference position."},
    SharedField{"velocity", SHOAL_RANK_VECTOR, "m/s", "Velocity."},
    SharedField{
        "acceleration", SHOAL_RANK_VECTOR, "m/s2",
        "Acceleration by everything that acts on a particle but its own internal forces (gravity, viscosity, "
        "contact, loads); operators add to it."},
    SharedField{"force", SHOAL_RANK_VECTOR, "N", "Force of other bodies on a particle."},
    SharedField{"mass", SHOAL_SCALAR, "kg", "Mass."},
    SharedField{"volume", SHOAL_SCALAR, "m3", "Volume; set to spacing^dimensions at the start."},
    SharedField{"density", SHOAL_SCALAR, "kg/m3", "Density."},
    SharedField{"pressure", SHOAL_SCALAR, "Pa", "Pressure."},
    SharedField{"temperature", SHOAL_SCALAR, "K", "Temperature."},
    SharedField{"normal", SHOAL_RANK_VECTOR, "1", "Unit normal of the body's surface, outward."},
    SharedField{"signed_distance", SHOAL_SCALAR, "m", "Distance to the body's surface, negative inside."},
    SharedField{"smoothing_length", SHOAL_SCALAR, "m", "Smoothing length where it varies between particles."},
    SharedField{"deformation_gradient", SHOAL_RANK_MATRIX, "1", "Deformation gradient F."},
    SharedField{"fibre", SHOAL_RANK_VECTOR, "1",
                "Unit direction of the fibres in the reference configuration."},
    SharedField{"sheet", SHOAL_RANK_VECTOR, "1",
                "Unit direction in the sheets, across the fibres, in the reference configuration."},
};

constexpr const SharedField* find_shared_field(std::string_view name) {
  for (const SharedField& field : shared_fields)
    if (field.name == name) return &field;
  return nullptr;
}

}  // namespace shoal
