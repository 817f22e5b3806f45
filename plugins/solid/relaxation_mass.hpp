// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Mass matrices for the relaxation to rest (relaxation.hpp), which is fast where the matrix is like the body's
// stiffness:
//   stiffness  that of the body as linear elasticity that turns with the material (tangent.hpp), factorised
//   bonds      of springs between next neighbours along the line between them,
//                sum over pairs of k_ij (e e^T + 1e-6 (I - e e^T)) on u_i - u_j,   k_ij = mu dx^(D-2),
//              twice that in 2D for pairs nearer than 1.2 dx; on a square lattice a solid with C11 = 3 mu,
//              C12 = C44 = mu. It has a tenth of the entries, but the body is softer at its surface than bonds are
//   lumped     row sums of the magnitudes of the bonds' matrix: a mass for each particle
// 1e-9 mu dx^(D-2) per particle keeps it definite, but does not hold a body that may move as a whole: planes of symmetry
// or a few clamped particles must.
#pragma once

#include <Eigen/SparseCholesky>
#include <cstdint>
#include <vector>

#include "tangent.hpp"

namespace shoal::solid {

enum class MassKind { stiffness, bonds, lumped };

class RelaxationMass {
 public:
  MassKind kind = MassKind::stiffness;

  // Bonds of a body.
  void connect(int dimensions, const shoal_neighbours& list, const double* reference_position, double spacing,
               double shear_modulus);
  // Of the body at `position`. Throws where the matrix is not positive definite.
  void assemble(const double* position, const TangentInput& input);
  bool assembled() const { return !at_.empty(); }
  void multiply(const double* u, double* f) const;
  void solve(const double* f, double* u) const;
  // Largest change of a bond since `assemble`, over its length: a turn by 0.1 rad makes 0.1.
  double changed(const double* position) const;
  // Largest difference of u between the ends of a bond, over its length.
  double stretch(const double* u) const;

 private:
  struct Bond {
    std::uint32_t i, j;
    double stiffness, length;  // N/m, m
  };
  using Matrix = Eigen::SparseMatrix<double>;
  using Entries = std::vector<Eigen::Triplet<double>>;
  Entries bond_entries(const double* position, const std::int64_t* held);

  std::size_t dimensions_ = 0, n_ = 0;
  bool analysed_ = false;
  double unit_ = 0;
  std::vector<Bond> bonds_;
  std::vector<double> at_, diagonal_;  // positions at the last assembly; row sums of magnitudes
  Matrix matrix_;                      // lower half, or empty
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> factor_;
};

}  // namespace shoal::solid
