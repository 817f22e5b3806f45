// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Nearly incompressible materials: the part of the energy that depends on the volume alone is taken of volume ratios at
// the nodes c of a grid of twice the spacing (pressure_grid.hpp),
//   J_c = sum_i V_i N_ci J_i / M_c,
//   energy = sum_i V_i [W(F_i) - U(J_i)] + sum_c M_c U(J_c),
//   P_i -> P_i + (p(J_i) - sum_c N_ci p(J_c)) J_i F_i^-T,   p = -U'.
// It is the gradient of an energy, so that all conservation laws hold, and costs less than a sum over neighbours.
//
// With one constraint J = 1 at each particle pressure alternates from particle to particle, as it does in elements of
// equal order. To take means over a neighbourhood does not cure it: what is left of the alternating modes, a tenth, is
// still stiff, and at surfaces there are combinations of the J of a few layers that no motion changes, whose pressure
// then grows with the bulk modulus. On the grid there is one pressure for 2^D particles, which move with D 2^D degrees
// of freedom, as in the stable pair of elements of Bercovier and Pironneau (1979), whose pressure is multilinear and
// whose displacement is so on half the spacing; and waves of two spacings have a mean of exactly zero.
#pragma once

#include <array>
#include <vector>

#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

// Names of the fields, in the loop and at the time of an output.
struct AveragingFields {
  const char *F, *P, *J, *correction;
};
inline constexpr AveragingFields loop_averaging{"deformation_gradient", "piola_stress", "volume_ratio",
                                                "pressure_correction"};
inline constexpr AveragingFields current_averaging{"current_deformation_gradient", "current_piola_stress",
                                                   "current_volume_ratio", "current_pressure_correction"};

struct VolumeRatio : ParticleOperator<VolumeRatio> {
  In<Matrix> F{"deformation_gradient", unit("1"), doc("Deformation gradient F.")};
  Out<Scalar> J{"volume_ratio", unit("1"), doc("det F."), derived};
  void rename(const AveragingFields& names) { F.rename(names.F), J.rename(names.J); }
  void particle(auto i) const { J[i] = determinant(F[i]); }
};

// The J_c, made in begin().
template <class Derived>
struct GridOperator : ParticleOperator<Derived> {
  In<Vector> reference_position{"reference_position"};
  In<Scalar> volume{"volume"};
  SharedStructure structure;

 protected:
  void average(const double* J) {
    PressureGrid& grid = structure->grid;
    if (!grid.built())
      grid.build(this->dimensions(), this->n_particles(), reference_position.data(), volume.data(),
                 structure->settings.spacing);
    nodes_.resize(grid.n_nodes());
    grid.means(J, nodes_.data());
  }
  std::vector<double> nodes_;
};

struct PressureCorrection : GridOperator<PressureCorrection> {
  In<Scalar> J{"volume_ratio", unit("1"), doc("det F.")};
  Out<Scalar> correction{"pressure_correction", unit("Pa"),
                         doc("Pressure of the volume ratio less that of the grid."), derived};
  void rename(const AveragingFields& names) { J.rename(names.J), correction.rename(names.correction); }

  void begin() {
    average(J.data());
    pressure_.resize(nodes_.size());
    structure->law.api->volumetric_pressure(structure->law.self, nodes_.size(), nodes_.data(),
                                            pressure_.data());
  }
  void block(std::uint64_t begin, std::uint64_t end) const {
    structure->law.api->volumetric_pressure(structure->law.self, end - begin, J.data() + begin,
                                            correction.data() + begin);
    for (std::uint64_t i = begin; i < end; ++i)
      correction.data()[i] -= structure->grid.at(i, pressure_.data());
  }

 private:
  std::vector<double> pressure_;
};

struct CorrectedStress : ParticleOperator<CorrectedStress> {
  In<Matrix> F{"deformation_gradient", unit("1"), doc("Deformation gradient F.")};
  In<Scalar> correction{"pressure_correction", unit("Pa"),
                        doc("Pressure of the volume ratio less that of the grid.")};
  InOut<Matrix> P{"piola_stress", unit("Pa"), doc("First Piola-Kirchhoff stress.")};
  void rename(const AveragingFields& names) {
    F.rename(names.F), correction.rename(names.correction), P.rename(names.P);
  }
  void particle(auto i) const { P[i] += (correction[i] * determinant(F[i])) * transpose(inverse(F[i])); }
};

// sum_c N_ci U(J_c) - U(J_i) is the integral of -p, here by Simpson's rule: the two are near one another.
struct AveragedStrainEnergy : GridOperator<AveragedStrainEnergy> {
  In<Scalar> J{"current_volume_ratio", unit("1"), doc("det F.")};
  InOut<Scalar> energy{"strain_energy", unit("J/m3"), doc("Stored energy per reference volume.")};

  void begin() { average(J.data()); }
  void particle(auto i) const {
    energy[i] += structure->grid.sum_at(i.index, [&](std::uint32_t c) {
      const double at[3] = {J[i], 0.5 * (J[i] + nodes_[c]), nodes_[c]};
      double p[3];
      structure->law.api->volumetric_pressure(structure->law.self, 3, at, p);
      return -(nodes_[c] - J[i]) / 6.0 * (p[0] + 4.0 * p[1] + p[2]);
    });
  }
};

}  // namespace shoal::solid
