// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Nearly incompressible materials: the part of the energy that depends on the volume alone is taken of the mean volume
// ratio of a neighbourhood,
//   Jm_i = sum_j s_ij J_j,  s_ij = V_j W_ij / n_i,  n_i = sum_j V_j W_ij, i itself among the j,
//   energy = sum_i V_i [W(F_i) - U(J_i) + U(Jm_i)],
//   P_i -> P_i + (p(J_i) - pm_i) J_i F_i^-T,  p = -U',  pm_i = sum_j V_j W_ij p(Jm_j) / n_j.
// With one constraint J = 1 at each particle pressure alternates from particle to particle, as it does in elements of
// equal order; the mean takes that mode out (a wave of two spacings keeps 0.08 of its volumetric stiffness) and is still
// the gradient of an energy, so that all conservation laws hold.
#pragma once

#include <array>
#include <vector>

#include "shoal/pair_operator.hpp"
#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

// Names of the fields, in the loop and at the time of an output.
struct AveragingFields {
  const char *F, *P, *J, *mean, *norm, *pressure, *correction;
};
inline constexpr AveragingFields loop_averaging{"deformation_gradient", "piola_stress",   "volume_ratio",
                                                "mean_volume_ratio",    "averaging_norm", "averaged_pressure",
                                                "pressure_correction"};
inline constexpr AveragingFields current_averaging{
    "current_deformation_gradient", "current_piola_stress",   "current_volume_ratio",
    "current_mean_volume_ratio",    "current_averaging_norm", "current_averaged_pressure",
    "current_pressure_correction"};

struct VolumeRatio : ParticleOperator<VolumeRatio> {
  In<Matrix> F{"deformation_gradient", unit("1"), doc("Deformation gradient F.")};
  Out<Scalar> J{"volume_ratio", unit("1"), doc("det F."), derived};
  void rename(const AveragingFields& names) { F.rename(names.F), J.rename(names.J); }
  void particle(auto i) const { J[i] = determinant(F[i]); }
};

// Sums over neighbours with the weights V_j W_ij of the reference configuration.
template <class Derived>
struct ReferenceAverage : PairOperator<Derived> {
  static constexpr const char* pair_geometry = "reference_position";
  template <int D>
  using Kernel = WendlandC2<D>;
  In<Scalar> volume{"volume"};
  auto store(const auto& p) const { return p.j(volume) * p.W(); }
};

struct MeanVolumeRatio : ReferenceAverage<MeanVolumeRatio> {
  In<Scalar> J{"volume_ratio", unit("1"), doc("det F.")};
  Out<Scalar> mean{"mean_volume_ratio", unit("1"), doc("det F, mean of the neighbourhood."), derived};
  Out<Scalar> norm{"averaging_norm", unit("1"), doc("Sum of the weights of the mean."), derived};
  void rename(const AveragingFields& names) {
    J.rename(names.J), mean.rename(names.mean), norm.rename(names.norm);
  }

  auto pair(const auto& p, const auto& weight) const { return sums(weight, weight * p.j(J)); }
  void begin() { self_ = self_W(); }
  void particle(auto i, double weights, double sum) const {
    const double own = volume[i] * self_;
    norm[i] = own + weights;
    mean[i] = (sum + own * J[i]) / norm[i];
  }

 private:
  double self_ = 0;
};

// p(Jm) / n, and p(J) to begin the correction with.
struct MeanPressureOfVolume : ParticleOperator<MeanPressureOfVolume> {
  In<Scalar> J{"volume_ratio", unit("1"), doc("det F.")};
  In<Scalar> mean{"mean_volume_ratio", unit("1"), doc("det F, mean of the neighbourhood.")};
  In<Scalar> norm{"averaging_norm", unit("1"), doc("Sum of the weights of the mean.")};
  Out<Scalar> pressure{"averaged_pressure", unit("Pa"),
                       doc("Pressure of the mean volume ratio over the norm."), derived};
  Out<Scalar> correction{"pressure_correction", unit("Pa"),
                         doc("Pressure of the volume ratio less its mean."), derived};
  SharedStructure structure;
  void rename(const AveragingFields& names) {
    J.rename(names.J), mean.rename(names.mean), norm.rename(names.norm);
    pressure.rename(names.pressure), correction.rename(names.correction);
  }

  void block(std::uint64_t begin, std::uint64_t end) const {
    const StressLaw& law = structure->law;
    law.api->volumetric_pressure(law.self, end - begin, mean.data() + begin, pressure.data() + begin);
    law.api->volumetric_pressure(law.self, end - begin, J.data() + begin, correction.data() + begin);
    for (std::uint64_t i = begin; i < end; ++i) pressure.data()[i] /= norm.data()[i];
  }
};

struct PressureCorrection : ReferenceAverage<PressureCorrection> {
  In<Scalar> pressure{"averaged_pressure", unit("Pa"),
                      doc("Pressure of the mean volume ratio over the norm.")};
  InOut<Scalar> correction{"pressure_correction", unit("Pa"),
                           doc("Pressure of the volume ratio less its mean.")};
  void rename(const AveragingFields& names) {
    pressure.rename(names.pressure), correction.rename(names.correction);
  }

  auto pair(const auto& p, const auto& weight) const { return weight * p.j(pressure); }
  void begin() { self_ = self_W(); }
  void particle(auto i, double sum) const { correction[i] -= sum + volume[i] * self_ * pressure[i]; }

 private:
  double self_ = 0;
};

struct CorrectedStress : ParticleOperator<CorrectedStress> {
  In<Matrix> F{"deformation_gradient", unit("1"), doc("Deformation gradient F.")};
  In<Scalar> correction{"pressure_correction", unit("Pa"),
                        doc("Pressure of the volume ratio less its mean.")};
  InOut<Matrix> P{"piola_stress", unit("Pa"), doc("First Piola-Kirchhoff stress.")};
  void rename(const AveragingFields& names) {
    F.rename(names.F), correction.rename(names.correction), P.rename(names.P);
  }
  void particle(auto i) const { P[i] += (correction[i] * determinant(F[i])) * transpose(inverse(F[i])); }
};

}  // namespace shoal::solid
