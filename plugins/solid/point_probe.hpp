// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// solid.point: displacement of a material point, by its place A in the reference configuration, which may lie on the
// surface, where no particle is:
//   u(A) = mean of u_i + (F_i - I) (A - X_i) over the particles nearest to A.
#pragma once

#include "shoal/probe.hpp"

namespace shoal::solid {

struct PointProbe final : Probe {
  Param<BodyName> body{"body", nullptr, "Solid body.", example("beam")};
  Param<Vector3> at{"at", "m", "Place of the point in the reference configuration.", example("[0.6, 0.2]")};

  std::vector<Column> columns() const override;
  std::vector<Need> needs() const override;
  void sample(const shoal_snapshot& snapshot, double* values) override;

 private:
  std::vector<std::size_t> nearest_;  // indices of particles, found in the first sample
};

}  // namespace shoal::solid
