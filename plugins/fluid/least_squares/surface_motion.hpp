// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Velocity and acceleration of a wall at the point x_s of its surface that is next to a particle of the wall. Walls of
// fluid.least_squares stay where they are, but may slide or turn: a field v of velocities, the same at all times. With its
// gradient G over the wall's particles around (linear least squares),
//   v_s = v + G (x_s - x),    a_s = G v_s
// exact for rotation, whose centripetal acceleration the pressure at the wall must balance.
#pragma once

#include "shoal/pair_operator.hpp"

#include "fit.hpp"

namespace shoal::fluid::least_squares {

inline constexpr const char *surface_velocity_doc = "Velocity of a wall at its surface.",
                            *surface_acceleration_doc = "Acceleration of a wall at its surface.";

struct SurfaceMotion : PairOperator<SurfaceMotion> {
  template <int D>
  using Kernel = Weight<D>;

  In<Vector> velocity{"velocity"};
  In<Vector> normal{"normal", own_only};
  In<Scalar> signed_distance{"signed_distance", own_only};
  Out<Vector> surface_velocity{"surface_velocity", unit("m/s"), doc(surface_velocity_doc)};
  Out<Vector> surface_acceleration{"surface_acceleration", unit("m/s2"), doc(surface_acceleration_doc)};

  auto pair(const auto& p) const {
    const auto w = p.W();
    const auto r = (-1.0 / p.h()) * p.r_ij();
    const auto v = p.j(velocity) - p.i(velocity);
    return sums(w, w * r, w * v, outer(w * r, r), outer(w * v, r));
  }
  template <int D>
  void particle(Particle<D> i, double weight, Vec<D> r, Vec<D> v, Mat<D> rr, Mat<D> vr) const {
    const double scale = 1.0 / (weight + self_w_);
    const Vec<D> mean_r = scale * r, mean_v = scale * v;
    Mat<D> moment = scale * rr - outer(mean_r, mean_r);
    for (int a = 0; a < D; ++a) moment(a, a) += 1e-9;  // where neighbours are too few, the wall moves as one
    const Mat<D> gradient =
        (1.0 / smoothing_length()) * ((scale * vr - outer(mean_v, mean_r)) * inverse(moment));
    surface_velocity[i] = velocity[i] - signed_distance[i] * (gradient * normal[i]);
    surface_acceleration[i] = gradient * surface_velocity[i];
  }
  void begin() { self_w_ = self_W(); }

 private:
  double self_w_ = 0;
};

}  // namespace shoal::fluid::least_squares
