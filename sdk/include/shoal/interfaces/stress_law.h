// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Interface of a material: the stress of a deformed solid. The solid plugin calls it with blocks of particles; a third
// party adds a material to the solid solver by registering one that offers this interface, and a material may wrap
// another one (an object of a parameter of kind SHOAL_OBJECT, made through its own shoal_material_api) and add to it.
// Authors in C++ derive from StressLaw (shoal/stress_law.hpp) instead of filling the table by hand.
//
// Symbols: F deformation gradient, J = det F, W stored energy per volume of the reference configuration, P = dW/dF
// first Piola-Kirchhoff stress. Matrices are D x D numbers, row by row: F[D * i + k] = dx_i / dX_k.
#pragma once

#include "shoal/abi.h"

#define SHOAL_STRESS_LAW "stress_law"
#define SHOAL_STRESS_LAW_REVISION 1u

// What the third direction does.
typedef enum shoal_kinematics {
  SHOAL_THREE_DIMENSIONAL = 0,  // D = 3
  SHOAL_PLANE_STRAIN = 1,       // D = 2, F33 = 1
  SHOAL_PLANE_STRESS = 2        // D = 2, the law finds the F33 at which P33 = 0
} shoal_kinematics;

enum {
  // The step is made: the law writes its state. Without it (probes, trials) the fields are only read.
  SHOAL_STRESS_UPDATES_STATE = 1u << 0
};

// n particles that stand one after the other.
typedef struct shoal_stress_block {
  uint32_t size;
  uint32_t kinematics;  // shoal_kinematics
  uint32_t flags;       // SHOAL_STRESS_*
  uint32_t reserved;
  uint64_t n;
  double time;                         // s, at the end of the step
  double dt;                           // s since the state was last written; for laws that depend on the rate
  const double* deformation_gradient;  // F at the end of the step
  double* const* fields;         // [field, in the order of `fields`]: at the block's first particle; padded
  double* stress;                // P, Pa; this and each of the following may be NULL
  double* energy;                // W, J/m3; what is stored, not what plastic flow dissipated
  double* out_of_plane_stress;   // P33, Pa; of blocks in the plane
  double* out_of_plane_stretch;  // F33; of blocks in the plane
} shoal_stress_block;

// Of the undeformed material.
typedef struct shoal_elastic_constants {
  uint32_t size;
  uint32_t reserved;
  double density;             // of the reference configuration, kg/m3
  double bulk_modulus;        // Pa
  double shear_modulus;       // Pa; a typical one of an anisotropic law
  double longitudinal_speed;  // m/s, the largest of all directions; in plane stress that of a plate
  double shear_speed;         // m/s
} shoal_elastic_constants;

typedef struct shoal_stress_law {
  uint32_t size;
  uint32_t reserved;
  // The fields that the law reads (directions, temperature, active tension, ...) or keeps (its state: read and
  // written), to be declared by whoever calls the law. Valid as long as the material. [main]
  const shoal_access* (*fields)(void* self, uint32_t kinematics, uint32_t* n_fields);
  // Writes the fields that the law writes, for n undeformed particles at these positions (n x D), and checks the
  // others. To be run once, before the first call of `stress` and not after a restart. [worker]
  shoal_status (*initialise)(void* self, uint32_t kinematics, uint64_t n, const double* reference_position,
                             double* const* fields);
  // [any]
  void (*constants)(void* self, uint32_t kinematics, shoal_elastic_constants* constants);
  // Fills what the block asks for. [worker]
  shoal_status (*stress)(void* self, const shoal_stress_block* block);
  // The part of the law that depends on the volume alone: W = U(J) + the rest, pressure -U'(J) in Pa. Its stress,
  // U'(J) J F^-T, is contained in `stress`, so that a solver may replace the pressure of nearly incompressible
  // materials by a smoothed one: P + (p(J) - p_smooth) J F^-T. NULL if the law has no such part. [worker]
  void (*volumetric_pressure)(void* self, uint64_t n, const double* jacobian, double* pressure);
  // Largest speed in m/s of plane waves, measured in the reference configuration, on top of the block's
  // deformation and state: for the time step of laws that stiffen. May cost twenty times `stress`. NULL if that of
  // the undeformed material always holds. [worker]
  shoal_status (*wave_speed)(void* self, const shoal_stress_block* block, double* speed);
} shoal_stress_law;
