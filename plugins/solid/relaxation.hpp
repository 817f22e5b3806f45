// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Relaxation to rest: damped motion with a mass matrix M of our choice, one step a unit of its time,
//   p^(n+1) = ((2 - c) p^n + 2 f^n) / (2 + c),   x^(n+1) = x^n + M^-1 p^(n+1),
// f the out-of-balance force of internal stress and loads on what is free to move, p momentum. The damping follows
// the motion: c = 2 w damps a motion of angular frequency w critically, and the Rayleigh quotient of the stiffness that
// the last step met (Underwood 1983; Oakley and Knight 1995) says what w is,
//   w^2 = u . (f^(n-1) - f^n) / (u . M u),   u = x^n - x^(n-1).
// It takes about sqrt(w_max / w_min) steps for each power of ten. With the body's own mass that is thousands, so M is
// theta times the stiffness of the body (relaxation_mass.hpp), which makes w nearly the same for all motions: some ten
// steps, and a few more where the body turns. It is assembled anew when bonds between neighbours have turned or
// stretched by a twentieth. theta puts the largest w^2 at 2, where a step with strong damping is Newton's; it is found
// by power iteration on the undeformed body, and raised if the quotient shows more. Large bodies in 3D take a lumped
// matrix instead: a mass for each particle, such that all local time steps are alike.
//
// A step changes no bond by more than a fifth of its length. All of it is serial, the same on any number of threads.
#pragma once

#include <memory>
#include <vector>

#include "relaxation_mass.hpp"
#include "shoal/particle_operator.hpp"
#include "structure.hpp"

namespace shoal::solid {

// What the bodies of a quasi-static run share.
struct Rest {
  double tolerance = 0;                             // of the out-of-balance force, over the forces at work
  double from = 0;                                  // s, when loads have reached what they stay at
  double dt = 0;                                    // s
  std::uint64_t iterations = 0;                     // at most
  double out_of_balance = 0, inner = 0, outer = 0;  // sums of squares of forces, N2

  // The out-of-balance force over the forces that act; 0 where none does.
  double relative() const;
};

// Adds one body's forces to the sums.
struct OutOfBalance : ParticleOperator<OutOfBalance> {
  In<Vector> internal{"internal_acceleration", unit("m/s2"), doc("Acceleration by the body's own stress.")};
  In<Vector> acceleration{"acceleration"};
  In<Scalar> mass{"mass"};
  In<Integer> held{"held_axes", unit("1"), doc("Bit a: the motion along axis a is given.")};
  Sum out_of_balance, inner, outer;
  std::shared_ptr<Rest> rest;
  bool first = false;  // of the bodies

  void particle(auto i) const {
    constexpr int D = decltype(i)::dimensions;
    const double m = mass[i];
    double free = 0;
    for (int a = 0; a < D; ++a)
      if ((held[i] >> a & 1) == 0) free += std::pow(m * (internal[i][a] + acceleration[i][a]), 2);
    out_of_balance.update(i, free);
    inner.update(i, m * m * squared_norm(internal[i]));
    outer.update(i, m * m * squared_norm(acceleration[i]));
  }
  void end();
};

struct Relaxation : WeightBuilder {
  In<Vector> internal{"internal_acceleration", unit("m/s2"), doc("Acceleration by the body's own stress."),
                      own_only};
  In<Vector> acceleration{"acceleration", own_only};
  In<Scalar> mass{"mass", own_only};
  In<Matrix> F{"deformation_gradient", own_only};
  In<Integer> held{"held_axes", unit("1"), doc("Bit a: the motion along axis a is given."), own_only};
  InOut<Vector> momentum{"relaxation_momentum", unit("N"), doc("Momentum of the relaxation to rest.")};
  InOut<Vector> force{"relaxation_force", unit("N"), doc("Out-of-balance force of the last step.")};
  InOut<Vector> at{"relaxation_position", unit("m"),
                   doc("Where the mass matrix of the relaxation belongs to.")};
  InOut<Matrix> F_at{"relaxation_gradient", unit("1"), doc("Deformation gradient there.")};
  InOut<Vector> position{"position"};
  InOut<Vector> velocity{"velocity"};

  std::shared_ptr<Rest> rest;
  MassKind kind = MassKind::stiffness;
  bool first = false;  // of the bodies: it tells how the run goes

  void begin();
  template <int D>
  void run_chunk(const shoal_chunk&) const {}
  double time_step(double) const { return rest->dt; }

  void save(const shoal_stream& stream) const;
  void load(const shoal_stream& stream);

 private:
  bool at_rest() const;
  void assemble();
  void look_at_mass();
  double largest_square() const;
  double damping(const std::vector<double>& now);
  void move(const std::vector<double>& now, double c);

  struct State {
    std::uint64_t started = 0, assembled_at = 0;
    double theta = 1.0;
  } state_;
  RelaxationMass mass_;
  std::vector<double> step_;
};

}  // namespace shoal::solid
