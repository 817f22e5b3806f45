// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What outputs and probes may ask for, computed when one is due, from the positions of that moment (the loop's own F
// and P belong to the middle of the last step):
//   displacement      x - X
//   cauchy_stress     sigma = P F^T / J, and out_of_plane_stress sigma_33 in two dimensions
//   von_mises         sqrt(3/2 s : s), s the deviator of sigma with sigma_33
//   principal_stress  eigenvalues of sigma in the plane or in space, largest first
//   pressure          -tr(sigma) / 3
//   strain_energy     W per reference volume; hourglass_energy that of the control
//   non_affine        |x_ij - (F_i + F_j) / 2 X_ij|^2 / dx^2, mean over the neighbours: zero for linear and quadratic
//                     motions, so what of a neighbourhood is noise (Ganzenmueller 2015 measures its square root)
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reference_weights.hpp"
#include "shoal/eigen.hpp"
#include "stress.hpp"

namespace shoal::solid {

struct Displacement : ParticleOperator<Displacement> {
  In<Vector> position{"position"};
  In<Vector> reference_position{"reference_position"};
  Out<Vector> displacement{"displacement"};

  void particle(auto i) const { displacement[i] = position[i] - reference_position[i]; }
};

struct CauchyStress : ParticleOperator<CauchyStress> {
  In<Matrix> F{"current_deformation_gradient", unit("1"), doc("F at the time of the output.")};
  Out<Matrix> sigma{"cauchy_stress", unit("Pa"), doc("Cauchy stress."), derived};
  Out<Scalar> out_of_plane{"out_of_plane_stress", unit("Pa"), doc("Cauchy stress across the plane; 0 in 3D."),
                           derived};
  DeclaredFields law_fields{*this};
  SharedStructure structure;

  void block(std::uint64_t begin, std::uint64_t end) const {
    dimensions() == 2 ? stresses<2>(begin, end) : stresses<3>(begin, end);
  }

 private:
  template <int D>
  void stresses(std::uint64_t begin, std::uint64_t end) const {
    std::array<double*, DeclaredFields::most> fields;
    law_fields.at(begin, fields.data());
    shoal_stress_block block = stress_block(*structure, end - begin, F.data() + begin * D * D, fields.data());
    block.time = time();
    block.stress = sigma.data() + begin * D * D;
    std::vector<double> p33(end - begin, 0.0), f33(end - begin, 1.0);
    if (D == 2) block.out_of_plane_stress = p33.data(), block.out_of_plane_stretch = f33.data();
    check_host(structure->law.api->stress(structure->law.self, &block));
    for (std::uint64_t k = begin; k < end; ++k) {
      const Particle<D> i{k, nullptr};
      const double J = determinant(F[i]);
      sigma[i] = (1.0 / (J * f33[k - begin])) * (sigma[i] * transpose(F[i]));
      out_of_plane[i] = p33[k - begin] / J;
    }
  }
};

// What averaging the volume ratio (volume_averaging.hpp) changes in both.
struct AveragedCauchyStress : ParticleOperator<AveragedCauchyStress> {
  In<Scalar> correction{"current_pressure_correction", unit("Pa"),
                        doc("Pressure of the volume ratio less that of the grid.")};
  InOut<Matrix> sigma{"cauchy_stress", unit("Pa"), doc("Cauchy stress.")};
  InOut<Scalar> out_of_plane{"out_of_plane_stress", unit("Pa"),
                             doc("Cauchy stress across the plane; 0 in 3D.")};

  void particle(auto i) const {
    constexpr int D = decltype(i)::dimensions;
    sigma[i] += correction[i] * identity<D>();
    if (D == 2) out_of_plane[i] += correction[i];
  }
};

struct VonMises : ParticleOperator<VonMises> {
  In<Matrix> sigma{"cauchy_stress", unit("Pa"), doc("Cauchy stress.")};
  In<Scalar> out_of_plane{"out_of_plane_stress", unit("Pa"), doc("Cauchy stress across the plane; 0 in 3D.")};
  Out<Scalar> von_mises{"von_mises", unit("Pa"), doc("Equivalent stress after von Mises."), derived};

  void particle(auto i) const {
    const double third = (trace(sigma[i]) + out_of_plane[i]) / 3.0;
    constexpr int D = decltype(i)::dimensions;
    const auto s = sigma[i] - third * identity<D>();
    double square = double_dot(s, s);
    if (D == 2) square += (out_of_plane[i] - third) * (out_of_plane[i] - third);
    von_mises[i] = std::sqrt(1.5 * square);
  }
};

struct PrincipalStress : ParticleOperator<PrincipalStress> {
  In<Matrix> sigma{"cauchy_stress", unit("Pa"), doc("Cauchy stress.")};
  Out<Vector> principal{"principal_stress", unit("Pa"), doc("Principal stresses, largest first."), derived};

  void particle(auto i) const {
    constexpr int D = decltype(i)::dimensions;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> solver;
    const Mat<D> symmetric = symmetric_part(sigma[i]);
    solver.computeDirect(as_eigen(symmetric), Eigen::EigenvaluesOnly);
    for (int k = 0; k < D; ++k) principal[i][k] = solver.eigenvalues()[D - 1 - k];
  }
};

struct MeanPressure : ParticleOperator<MeanPressure> {
  In<Matrix> sigma{"cauchy_stress", unit("Pa"), doc("Cauchy stress.")};
  In<Scalar> out_of_plane{"out_of_plane_stress", unit("Pa"), doc("Cauchy stress across the plane; 0 in 3D.")};
  Out<Scalar> pressure{"pressure", derived};

  void particle(auto i) const { pressure[i] = -(trace(sigma[i]) + out_of_plane[i]) / 3.0; }
};

struct StrainEnergy : ParticleOperator<StrainEnergy> {
  In<Matrix> F{"current_deformation_gradient", unit("1"), doc("F at the time of the output.")};
  Out<Scalar> energy{"strain_energy", unit("J/m3"), doc("Stored energy per reference volume."), derived};
  DeclaredFields law_fields{*this};
  SharedStructure structure;

  void block(std::uint64_t begin, std::uint64_t end) const {
    std::array<double*, DeclaredFields::most> fields;
    law_fields.at(begin, fields.data());
    const auto d = static_cast<std::uint64_t>(dimensions());
    shoal_stress_block block = stress_block(*structure, end - begin, F.data() + begin * d * d, fields.data());
    block.time = time();
    block.energy = energy.data() + begin;
    check_host(structure->law.api->stress(structure->law.self, &block));
  }
};

struct HourglassEnergy : ParticleOperator<HourglassEnergy> {
  In<Vector> q{"current_hourglass_stress", unit("N/m3"), doc("Hourglass control at the time of the output.")};
  Out<Scalar> energy{"hourglass_energy", unit("J/m3"),
                     doc("Energy of the hourglass control per reference volume."), derived};
  double stiffness = 0;  // N/m4

  void particle(auto i) const { energy[i] = squared_norm(q[i]) / (2.0 * stiffness); }
};
// Where there is no control.
struct NoHourglassEnergy : ParticleOperator<NoHourglassEnergy> {
  Out<Scalar> energy{"hourglass_energy", unit("J/m3"),
                     doc("Energy of the hourglass control per reference volume."), derived};
  void particle(auto i) const { energy[i] = 0.0; }
};

struct NonAffine : ReferenceOperator {
  In<Vector> reference_position{"reference_position"};
  In<Vector> position{"position"};
  In<Matrix> F{"current_deformation_gradient", unit("1"), doc("F at the time of the output.")};
  Out<Scalar> non_affine{"non_affine", unit("1"), doc("Non-affine part of the motion of the neighbours."),
                         derived};

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    const double per_square = 1.0 / (spacing() * spacing());
    for (std::uint64_t k = chunk.begin; k < chunk.end; ++k) {
      const Particle<D> i{k, nullptr};
      const Row row = row_of(neighbours(0), k);
      double sum = 0;
      for (std::uint32_t m = 0; m < row.n; ++m) {
        const Particle<D> j{row.j[m], nullptr};
        const Vec<D> X = reference_position[i] - reference_position[j];
        sum += squared_norm(position[i] - position[j] - 0.5 * (F[i] + F[j]) * X);
      }
      non_affine[i] = row.n > 0 ? per_square * sum / row.n : 0.0;
    }
  }
};

}  // namespace shoal::solid
