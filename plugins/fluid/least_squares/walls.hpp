// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Walls. A wall's particle carries what continues the fluid's fields through the wall's surface, so that the fits of the
// fluid take it for one of theirs. With x_s the point of the surface next to it and a fit over the fluid around x_s,
// P(d) = (1, d_a/h, d_a d_b/h^2), d = x - x_s, weights W(|d|):
//   velocity   v = v_w + c.P(d) without the 1: the fluid sticks to the wall
//              free slip: so the part along the normal n; the rest v = c.P(d) with dv/dn = 0 at x_s
//   pressure   p = c.P(d) with dp/dn = rho n.[f - a_w + (v' - v_w)/(4 dt)] at x_s: within some steps dt a velocity v' of the
//              fluid at the wall becomes that of the wall, so that no flow through it can build up
//   force f    linear, at x_s;  v' too
// v_w and a_w are velocity and acceleration of the wall at x_s (surface_motion.hpp). Velocity and pressure are continued to
// second order, exact for Poiseuille flow; free slip is exact at flat walls. The condition on a slope is an equation of the
// fit with a weight of `stiff` times all others. Where neighbours are too few, as in corners, or a row would amplify noise
// more than fourfold, the fit is linear, then constant.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "shoal/fit.hpp"
#include "shoal/pair_operator.hpp"

#include "course.hpp"
#include "fit.hpp"
#include "motion.hpp"
#include "pressure.hpp"
#include "surface_motion.hpp"
#include "viscosity.hpp"

namespace shoal::fluid::least_squares {

using VelocityRow = Array<5, 9>;   // of P without the 1
using PressureRow = Array<7, 11>;  // of P, and the weight of dp/dn
using ForceRow = Array<3, 4>;      // of the linear part of P

inline constexpr const char *velocity_row_doc = "Row of the fit that continues velocities into a wall.",
                            *pressure_row_doc = "Row of the fit that continues the pressure into a wall.",
                            *offset_doc = "From the surface to a particle of a wall.",
                            *force_row_doc = "Row of the fit that continues forces into a wall.",
                            *normal_force_doc =
                                "What the slope of the pressure at a wall balances, over density.";

// Monomials of (x_j - x_s) / h with the 1, and their weight.
template <int D, class R>
struct SurfacePoint {
  static constexpr int terms = fit_terms<D> + 1;
  Vec<terms, R> monomials;
  R weight;
};
template <class P, class Offset>
auto surface_point(const P& p, const Offset& offset) {
  constexpr int D = P::dimensions;
  using R = typename P::RealType;
  Vec<D, R> d;
  for (int a = 0; a < D; ++a) d[a] = offset[a] - p.r_ij()[a];
  const auto q = fit_monomials((1.0 / p.h()) * d);
  SurfacePoint<D, R> point;
  point.monomials[0] = R(1.0);
  for (int k = 0; k < fit_terms<D>; ++k) point.monomials[k + 1] = q[k];
  point.weight = Weight<D>(p.h()).w(sqrt(max(R(1e-200), squared_norm(d))));
  return point;
}

// From the point of the surface next to a wall's particle to the particle. Zero where no fluid is at that point, as at
// the end of a wall that another one continues: there fields are continued as constants from the fluid around.
struct WallSurface : PairOperator<WallSurface> {
  template <int D>
  using Kernel = Weight<D>;
  static constexpr double wet_above = 0.25;  // share of the smoothing kernel that fluid fills

  In<Vector> normal{"normal", own_only};
  In<Scalar> signed_distance{"signed_distance", own_only};
  Out<Vector> offset{"surface_offset", unit("m"), doc(offset_doc), derived};

  auto pair(const auto& p) const { return surface_point(p, p.i(signed_distance) * p.i(normal)).weight; }
  void particle(auto i, double weights) const {
    const bool wet = weights * std::pow(spacing(), i.dimensions) > wet_above;
    offset[i] = (wet ? signed_distance[i] : 0.0) * normal[i];
  }
};

// Rows of the fits of a wall's particle; i is the wall's, j the fluid's.
struct WallFit : PairOperator<WallFit> {
  template <int D>
  using Kernel = Weight<D>;
  static constexpr double stiff = 1e4;
  static constexpr double most_noise = 4.0;

  In<Vector> offset{"surface_offset", unit("m"), doc(offset_doc), derived, own_only};
  Out<VelocityRow> velocity_row{"wall_velocity_row", unit("1"), doc(velocity_row_doc), derived};
  Out<PressureRow> pressure_row{"wall_pressure_row", unit("1"), doc(pressure_row_doc), derived};
  Out<ForceRow> force_row{"wall_force_row", unit("1"), doc(force_row_doc), derived};

  auto pair(const auto& p) const {
    using P = std::decay_t<decltype(p)>;
    const auto s = surface_point(p, p.i(offset));
    constexpr int N = decltype(s)::terms;
    Vec<N*(N + 1) / 2, typename P::RealType> m{};
    for (int r = 0, k = 0; r < N; ++r)
      for (int c = r; c < N; ++c) m[k++] = s.weight * s.monomials[r] * s.monomials[c];
    return m;
  }
  void particle(auto i, const auto& sums) const {
    constexpr int D = decltype(i)::dimensions, N = fit_terms<D> + 1;
    std::array<double, N * N> m{};
    for (int r = 0, k = 0; r < N; ++r)
      for (int c = r; c < N; ++c, ++k) m[at<N>(r, c)] = m[at<N>(c, r)] = sums[k];
    const double h = smoothing_length();
    const auto here = fit_monomials((1.0 / h) * offset[i]);  // of the particle itself, seen from x_s
    const double depth = norm(offset[i]);
    const bool wet = depth > 0.0;
    const Vec<D> n = (wet ? -1.0 / depth : 0.0) * offset[i];
    velocity_row[i] = velocity<D>(m, here, wet);
    force_row[i] = force<D>(m, wet);
    pressure_row[i] = pressure<D>(m, here, n, h, wet);
  }

 private:
  template <int N>
  static constexpr std::size_t at(int row, int column) {
    return static_cast<std::size_t>(row * N + column);
  }

  // Solves the leading n x n block of `moments` for the row that gives the fit's value at `monomials`. `data` are the
  // moments without conditions: they tell by how much the row amplifies noise, sum_j e_j^2 / W_j over that of the mean.
  template <int N>
  static bool solve(const std::array<double, N * N>& moments, const std::array<double, N * N>& data,
                    double sum_of_weights, const Vec<N>& monomials, int n, std::array<double, N>& row) {
    std::array<double, N * N> inverse{};
    if (!fit::invert<N>(moments, n, inverse)) return false;
    std::array<double, N> found{};
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c) found[static_cast<std::size_t>(c)] += monomials[r] * inverse[at<N>(r, c)];
    double noise = 0;
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c)
        noise += found[static_cast<std::size_t>(r)] * data[at<N>(r, c)] * found[static_cast<std::size_t>(c)];
    if (!(sum_of_weights * noise <= most_noise * most_noise)) return false;
    row = found;
    return true;
  }

  template <int D>
  static auto velocity(const std::array<double, (fit_terms<D> + 1) * (fit_terms<D> + 1)>& m,
                       const Vec<fit_terms<D>>& here, bool wet) {
    constexpr int N = fit_terms<D>;
    std::array<double, N * N> block{};
    for (int r = 0; r < N; ++r)
      for (int c = 0; c < N; ++c) block[at<N>(r, c)] = m[at<N + 1>(r + 1, c + 1)];
    std::array<double, N> row{};
    if (wet && !solve<N>(block, block, m[0], here, N, row)) solve<N>(block, block, m[0], here, D, row);
    return row;
  }

  template <int D>
  static auto force(const std::array<double, (fit_terms<D> + 1) * (fit_terms<D> + 1)>& m, bool wet) {
    constexpr int N = fit_terms<D> + 1;
    Vec<N> surface{};
    surface[0] = 1.0;
    std::array<double, N> row{};
    if (!wet || !solve<N>(m, m, m[0], surface, D + 1, row)) solve<N>(m, m, m[0], surface, 1, row);
    std::array<double, D + 1> leading{};
    std::copy_n(row.begin(), D + 1, leading.begin());
    return leading;
  }

  template <int D>
  static auto pressure(const std::array<double, (fit_terms<D> + 1) * (fit_terms<D> + 1)>& m,
                       const Vec<fit_terms<D>>& here, const Vec<D>& n, double h, bool wet) {
    constexpr int N = fit_terms<D> + 1;
    const double weight = stiff * m[0];
    auto conditioned = m;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) conditioned[at<N>(a + 1, b + 1)] += weight * n[a] * n[b];
    Vec<N> there{};
    there[0] = 1.0;
    for (int k = 1; k < N; ++k) there[k] = here[k - 1];
    std::array<double, N> row{};
    if (!wet || (!solve<N>(conditioned, m, m[0], there, N, row) &&
                 !solve<N>(conditioned, m, m[0], there, D + 1, row)))
      solve<N>(m, m, m[0], there, 1, row);
    std::array<double, N + 1> with_slope{};
    std::copy_n(row.begin(), N, with_slope.begin());
    for (int a = 0; a < D; ++a)
      with_slope[N] += weight * n[a] * h * with_slope[static_cast<std::size_t>(a + 1)];
    return with_slope;
  }
};

// What is continued into walls. Velocities of another time than the midpoint are those of the wall's material then: to an
// observer who stays at the midpoint its velocity turns. `time` counts from there, in steps.
struct MidVelocity {
  static constexpr const char *name = "velocity_mid", *unit_text = "m/s", *doc_text = v_mid_doc;
  static double time(const Course&) { return 0.0; }
};
struct CarriedVelocity {
  static constexpr const char *name = "carried_velocity", *unit_text = "m/s", *doc_text = carried_doc;
  static double time(const Course&) { return -0.5; }
};
struct StageVelocity {
  static constexpr const char *name = "viscous_velocity", *unit_text = "m/s", *doc_text = stage_doc;
  static double time(const Course& course) {
    return LegendreStage::time(course.viscous_stage, course.viscous_stages) - 0.5;
  }
};
struct MeanViscous {
  static constexpr const char *name = "viscous_acceleration", *unit_text = "m/s2", *doc_text = viscous_doc;
};
struct SpecificForce {
  static constexpr const char *name = "specific_force", *unit_text = "m/s2", *doc_text = force_doc;
};
struct MidPressure {
  static constexpr const char *name = "pressure_mid", *unit_text = "Pa", *doc_text = p_mid_doc;
  static double factor(const Course&) { return 1.0; }
};
struct PressureWave {
  static constexpr const char *name = "pressure_wave", *unit_text = "Pa m2/s2", *doc_text = wave_doc;
  static double factor(const Course& course) { return course.sound_speed * course.sound_speed; }
};
struct PressureImpulse {
  static constexpr const char *name = "pressure_impulse", *unit_text = "Pa s", *doc_text = impulse_doc;
  static double factor(const Course& course) { return course.dt; }
};

// Weight of the fluid's particle j in the continuation by a row of the fit whose first monomial is the `first` of P.
template <class P, class Row, class Offset>
auto continuation(const P& p, const Row& row, std::size_t n, int first, const Offset& offset) {
  const auto s = surface_point(p, offset);
  typename P::RealType weight = 0.0;
  for (std::size_t k = 0; k < n; ++k) weight += row[k] * s.monomials[static_cast<int>(k) + first];
  return weight * s.weight;
}

// What the continuations of velocities share.
template <class Derived, class Of>
struct ContinuedVelocity : PairOperator<Derived> {
  template <int D>
  using Kernel = Weight<D>;

  In<Vector> offset{"surface_offset", unit("m"), doc(offset_doc), derived, own_only};
  In<VelocityRow> row{"wall_velocity_row", unit("1"), doc(velocity_row_doc), derived, own_only};
  In<Vector> wall_velocity{"surface_velocity", unit("m/s"), doc(surface_velocity_doc), own_only};
  In<Vector> wall_acceleration{"surface_acceleration", unit("m/s2"), doc(surface_acceleration_doc), own_only};
  In<Vector> of_fluid{Of::name, unit(Of::unit_text), doc(Of::doc_text), derived, neighbours_only};
  Out<Vector> continued{Of::name, unit(Of::unit_text), doc(Of::doc_text), derived};

  CoursePointer course;
  double since_midpoint = 0;  // s

  void begin() { since_midpoint = Of::time(*course) * course->dt; }

 protected:
  // The velocity of j beyond that of the wall, and its weight in the continuation without the 1.
  auto beyond_wall(const auto& p) const {
    return p.j(of_fluid) - (p.i(wall_velocity) + since_midpoint * p.i(wall_acceleration));
  }
  auto weight(const auto& p) const {
    const auto& e = p.i(row);
    return continuation(p, e, e.size(), 1, p.i(offset));
  }
  auto of_wall(auto i) const { return wall_velocity[i] + since_midpoint * wall_acceleration[i]; }
};

template <class Of>
struct WallVelocity : ContinuedVelocity<WallVelocity<Of>, Of> {
  auto pair(const auto& p) const { return this->weight(p) * this->beyond_wall(p); }
  void particle(auto i, auto sum) const { this->continued[i] = this->of_wall(i) + sum; }
};

template <class Of>
struct FreeSlipWallVelocity : ContinuedVelocity<FreeSlipWallVelocity<Of>, Of> {
  In<Vector> normal{"normal", own_only};
  In<PressureRow> slope_row{"wall_pressure_row", unit("1"), doc(pressure_row_doc), derived, own_only};

  auto pair(const auto& p) const {
    const auto& f = p.i(slope_row);
    return sums(this->weight(p) * dot(p.i(normal), this->beyond_wall(p)),
                continuation(p, f, f.size() - 1, 0, p.i(this->offset)) * p.j(this->of_fluid));
  }
  void particle(auto i, double across, auto along) const {
    const auto n = normal[i];
    this->continued[i] = along + (dot(n, this->of_wall(i) - along) + across) * n;
  }
};

template <class Of>
struct WallForceField : PairOperator<WallForceField<Of>> {
  template <int D>
  using Kernel = Weight<D>;

  In<Vector> offset{"surface_offset", unit("m"), doc(offset_doc), derived, own_only};
  In<ForceRow> row{"wall_force_row", unit("1"), doc(force_row_doc), derived, own_only};
  In<Vector> of_fluid{Of::name, unit(Of::unit_text), doc(Of::doc_text), derived, neighbours_only};
  Out<Vector> continued{Of::name, unit(Of::unit_text), doc(Of::doc_text)};

  auto pair(const auto& p) const {
    const auto& e = p.i(row);
    return continuation(p, e, e.size(), 0, p.i(offset)) * p.j(of_fluid);
  }
  void particle(auto i, auto sum) const { continued[i] = sum; }
};

// dp/dn / rho at the surface. Taking all of the flow through the wall back in one step lets noise of the fits grow (in the
// lid-driven cavity at Re 1000 the run fails within 6 L/U; with a half or less it does not, without any within 0.3 L/U).
struct WallNormalForce : PairOperator<WallNormalForce> {
  template <int D>
  using Kernel = Weight<D>;
  static constexpr double relaxation = 0.25;

  In<Vector> offset{"surface_offset", unit("m"), doc(offset_doc), derived, own_only};
  In<ForceRow> row{"wall_force_row", unit("1"), doc(force_row_doc), derived, own_only};
  In<Vector> normal{"normal", own_only};
  In<Vector> force{"specific_force", unit("m/s2"), doc(force_doc), own_only};
  In<Vector> wall_velocity{"surface_velocity", unit("m/s"), doc(surface_velocity_doc), own_only};
  In<Vector> wall_acceleration{"surface_acceleration", unit("m/s2"), doc(surface_acceleration_doc), own_only};
  In<Vector> carried{"carried_velocity", unit("m/s"), doc(carried_doc), derived, neighbours_only};
  Out<Scalar> normal_force{"wall_normal_force", unit("m/s2"), doc(normal_force_doc)};

  CoursePointer course;

  auto pair(const auto& p) const {
    const auto& e = p.i(row);
    return continuation(p, e, e.size(), 0, p.i(offset)) * (p.j(carried) - p.i(wall_velocity));
  }
  void particle(auto i, auto slip) const {
    const double dt = course->dt;
    const auto through = slip + 0.5 * dt * wall_acceleration[i];  // v' is of the beginning of the step
    normal_force[i] = dot(normal[i], force[i] - wall_acceleration[i] + (relaxation / dt) * through);
  }
};

// The force is that of the step before where the pressure at the midpoint is continued.
template <class Of>
struct WallPressure : PairOperator<WallPressure<Of>> {
  template <int D>
  using Kernel = Weight<D>;

  In<Vector> offset{"surface_offset", unit("m"), doc(offset_doc), derived, own_only};
  In<PressureRow> row{"wall_pressure_row", unit("1"), doc(pressure_row_doc), derived, own_only};
  In<Scalar> normal_force{"wall_normal_force", unit("m/s2"), doc(normal_force_doc), own_only};
  In<Scalar> of_fluid{Of::name, unit(Of::unit_text), doc(Of::doc_text), derived, neighbours_only};
  Out<Scalar> continued{Of::name, unit(Of::unit_text), doc(Of::doc_text), derived};

  CoursePointer course;
  double density = 0;  // kg/m3

  auto store(const auto& p) const {
    const auto& e = p.i(row);
    return continuation(p, e, e.size() - 1, 0, p.i(offset));
  }
  auto pair(const auto& p, const auto& weight) const { return weight * p.j(of_fluid); }
  void particle(auto i, double sum) const {
    continued[i] = sum + row[i].back() * Of::factor(*course) * density * normal_force[i];
  }
};

}  // namespace shoal::fluid::least_squares
