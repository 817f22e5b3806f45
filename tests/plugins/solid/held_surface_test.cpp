// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A body that is built into a rigid shape: the displacement vanishes at the surface of the shape, wherever particles lie.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "deformation.hpp"
#include "momentum.hpp"
#include "particles.hpp"

using namespace shoal;
using namespace shoal::solid;
using solid_test::dx;

namespace {

// All with x < position, at an angle to the axes: x + slope y < position.
struct HalfSpace {
  double position, slope;
};

shoal_status distance(void* self, std::uint64_t n, const double* points, double* out) {
  const auto& shape = *static_cast<const HalfSpace*>(self);
  for (std::uint64_t i = 0; i < n; ++i)
    out[i] =
        (points[3 * i] + shape.slope * points[3 * i + 1] - shape.position) / std::hypot(1.0, shape.slope);
  return SHOAL_OK;
}

SharedStructure built_into(HalfSpace& shape, double eps = 0.0) {
  static const shoal_shape_api api = [] {
    shoal_shape_api made{};
    made.size = sizeof made;
    made.distance = distance;
    return made;
  }();
  auto structure = std::make_shared<Structure>();
  structure->settings = solid_test::settings();
  structure->settings.eps = eps;
  structure->constants.density = 1000.0;
  structure->hourglass = 0.7;
  Region region;
  region.api = &api;
  region.shape = std::shared_ptr<void>(&shape, [](void*) {});
  region.margin = HeldSurface::margin(dx);
  structure->held = std::make_shared<std::vector<Region>>(1, region);
  return structure;
}

testing::Setup setup() {
  return {.smoothing_length = solid_test::settings().smoothing_length, .spacing = dx};
}

void deform(testing::Body& body, const SharedStructure& structure) {
  DeformationGradient op;
  op.structure = structure;
  testing::run(op, body, {&body}, setup());
}

HeldSurface surface_of(testing::Body& body, const SharedStructure& structure) {
  return structure->held_surface(body.dimensions(), body.size(), body["reference_position"].data());
}

// Displacement `first` d + `second` d^2 along all axes of particles at d in front of the surface.
template <int D>
void check_exact(double disorder, HalfSpace shape, double first, double second) {
  testing::Body body = solid_test::box(D, D == 2 ? 12 : 9, disorder);
  const SharedStructure structure = built_into(shape);
  const HeldSurface surface = surface_of(body, structure);
  const double size = std::hypot(1.0, shape.slope);
  const double normal[3] = {1.0 / size, shape.slope / size, 0.0};
  deform(body, structure);  // weights of the neighbours that the undeformed body has
  body.set_each("position", D, [&](std::size_t i, std::size_t a) {
    const double d = surface.distance[i];
    const double u = surface.holds(i) ? 0.0 : first * d + second * d * d;
    return body["reference_position"][i * D + a] + u;
  });
  deform(body, structure);
  std::size_t n_held = 0;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const bool held = surface.holds(i);
    n_held += held;
    // The far corners of disordered boxes have fits of first order.
    if (second != 0.0 && surface.distance[i] > 4.0 * dx) continue;
    const double slope = held ? 0.0 : first + 2.0 * second * surface.distance[i];
    double off = 0;
    for (std::size_t a = 0; a < D; ++a) {
      for (std::size_t b = 0; b < D; ++b)
        off = std::max(off, std::fabs(body["deformation_gradient"][(i * D + a) * D + b] -
                                      (a == b ? 1.0 : 0.0) - slope * normal[b]));
      off =
          std::max(off, dx / structure->hourglass * dx * std::fabs(body["hourglass_stress"][i * D + a]) / dx);
    }
    CHECK(off < 1e-10);
  }
  CHECK(n_held > 0);
}

}  // namespace

TEST_CASE("motions that vanish at the surface are exact up to it") {
  for (const double phase : {3.0, 3.05, 3.3, 3.5, 3.62, 3.9}) {
    CAPTURE(phase);
    check_exact<2>(0.0, {phase * dx, 0.0}, 0.2, 0.0);
    check_exact<2>(0.0, {phase * dx, 0.0}, 0.2, 0.3);
    check_exact<2>(0.2, {phase * dx, 0.0}, 0.2, 0.3);
    check_exact<2>(0.0, {phase * dx, 0.4}, 0.2, 0.3);
  }
  check_exact<3>(0.0, {3.2 * dx, 0.0}, 0.2, 0.3);
  check_exact<3>(0.2, {3.2 * dx, 0.3}, 0.2, 0.3);
}

TEST_CASE("a uniform stress is in balance at the surface") {
  for (const double phase : {3.0, 3.3, 3.5, 3.8}) {
    CAPTURE(phase);
    HalfSpace shape{phase * dx, 0.0};
    testing::Body body = solid_test::box(2, 32, 0.0);
    const SharedStructure structure = built_into(shape, 0.01);
    const HeldSurface surface = surface_of(body, structure);
    cut_volumes(surface, 2, body["reference_position"].data(), body["volume"].data());
    deform(body, structure);
    double largest = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      const double y = body["reference_position"][2 * i + 1];
      // Away from the free sides; what is left of the residual lies further inside (force_consistency.cpp).
      if (surface.holds(i) || std::fabs(y - 1.6) > 1.1 || surface.distance[i] > 4.0 * dx) continue;
      double r[2];
      structure->weights.residual(i, r);
      largest = std::max(largest, dx * std::max(std::fabs(r[0]), std::fabs(r[1])));
      ++count;
    }
    CHECK(count > 20);
    CHECK(largest < 5e-3);  // 0.5 without
  }
}

TEST_CASE("forces are the gradient of the energy of a body that is built in") {
  HalfSpace shape{2.3 * dx, 0.1};
  testing::Body body = solid_test::box(2, 8, 0.2);
  const SharedStructure structure = built_into(shape, 0.01);
  body.set_each("volume", 1, [&](std::size_t i, std::size_t) {
    return dx * dx * (1.0 + 0.2 * std::sin(static_cast<double>(i)));
  });
  body.set_each("position", 2, [&](std::size_t i, std::size_t a) {
    return body["reference_position"][2 * i + a] +
           0.01 * dx * std::sin(37.0 * static_cast<double>(2 * i + a));
  });
  // W = |F - 1|^2 / 2
  const auto energy = [&] {
    deform(body, structure);
    double sum = 0;
    for (std::size_t i = 0; i < body.size(); ++i) {
      for (std::size_t k = 0; k < 4; ++k)
        sum += 0.5 * body["volume"][i] *
               std::pow(body["deformation_gradient"][4 * i + k] - (k % 3 == 0 ? 1.0 : 0.0), 2);
      for (std::size_t a = 0; a < 2; ++a)
        sum += 0.5 * body["volume"][i] * std::pow(body["hourglass_stress"][2 * i + a], 2) * dx * dx /
               structure->hourglass;
    }
    return sum;
  };
  energy();
  body.set_each("piola_stress", 4, [&](std::size_t i, std::size_t k) {
    return body["deformation_gradient"][4 * i + k] - (k % 3 == 0 ? 1.0 : 0.0);
  });
  InternalForce op;
  op.structure = structure;
  testing::run(op, body, {&body}, setup());
  const std::vector<double> acceleration = body["internal_acceleration"];
  double scale = 0;
  for (const double a : acceleration) scale = std::max(scale, std::fabs(a));
  for (std::size_t k = 0; k < 2 * body.size(); k += 3) {
    double& x = body["position"][k];
    const double before = x, step = 1e-5 * dx;
    x = before + step;
    const double more = energy();
    x = before - step;
    const double less = energy();
    x = before;
    const double expected = -(more - less) / (2.0 * step) / (1000.0 * body["volume"][k / 2]);
    CHECK(std::fabs(acceleration[k] - expected) < 1e-6 * scale);
  }
}

TEST_CASE("volumes are what is in front of the surface") {
  for (const double phase : {3.0, 3.2, 3.45, 3.55, 3.97}) {
    CAPTURE(phase);
    HalfSpace shape{phase * dx, 0.0};
    testing::Body body = solid_test::box(3, 8, 0.0);
    const SharedStructure structure = built_into(shape);
    const HeldSurface surface = surface_of(body, structure);
    cut_volumes(surface, 3, body["reference_position"].data(), body["volume"].data());
    double sum = 0;
    for (std::size_t i = 0; i < body.size(); ++i)
      if (!surface.holds(i)) sum += body["volume"][i];
    CHECK(sum == doctest::Approx((8.0 - phase) * 64.0 * dx * dx * dx).epsilon(1e-12));
  }
}

TEST_CASE("the two outermost layers weigh 25/24 and 23/24, which integrates y^2 to third order") {
  const auto error = [](std::size_t n) {
    std::vector<double> distance(n), volume(n);
    const double h = 1.0 / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i)
      volume[i] = h,
      distance[i] = -std::min(static_cast<double>(i) + 0.5, static_cast<double>(n - i) - 0.5) * h;
    correct_ends(n, distance.data(), h, volume.data());
    CHECK(std::accumulate(volume.begin(), volume.end(), 0.0) == doctest::Approx(1.0));
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      sum += volume[i] * std::pow((static_cast<double>(i) + 0.5) * h - 0.5, 2);
    return std::fabs(12.0 * sum - 1.0);
  };
  CHECK(error(12) < 0.002);  // 0.007 with equal volumes
  CHECK(error(6) / error(12) > 7.0);
}
