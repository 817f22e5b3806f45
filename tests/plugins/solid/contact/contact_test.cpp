// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Contact against plain loops over all pairs: forces are the derivative of the energy of the overlaps, momentum is
// conserved, flat surfaces feel smooth and as stiff as asked for, and friction is Coulomb's.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "plugins/solid/contact.hpp"
#include "plugins/solid/contact_scale.hpp"
#include "plugins/solid/rigid_plane.hpp"
#include "shoal/testing.hpp"

using namespace shoal;
using namespace shoal::solid;
using shoal::testing::Body;

namespace {

constexpr double dx = 0.1, h = 1.3 * dx, K = 3.0, dt = 1e-3;
const testing::Setup setup{.smoothing_length = h, .spacing = dx, .dt = dt};

Target target_of() {
  Target target;
  target.smoothing_length = h;
  target.cutoff = 2.0 * h;
  return target;
}
double W(int dimensions, double r) {
  double w = 0.0;
  const auto evaluate = [&](const auto& kernel) { w = kernel.w(r); };
  dimensions == 2 ? with_kernel<2>(SmoothingKernel::wendland_c2, h, evaluate)
                  : with_kernel<3>(SmoothingKernel::wendland_c2, h, evaluate);
  return w;
}

// A lattice block of n particles along each axis with its lowest corner at `lower`, its particles moved by `noise`.
Body block(int dimensions, int n, std::array<double, 3> lower, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> number(-noise, noise);
  std::vector<double> x;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int c = 0; c < (dimensions == 3 ? n : 1); ++c) {
        const std::array<int, 3> at{a, b, c};
        for (std::size_t k = 0; k < static_cast<std::size_t>(dimensions); ++k)
          x.push_back(lower[k] + (at[k] + 0.5) * dx + number(random));
      }
  Body body(dimensions, x);
  body["reference_position"] = x;
  body.set_each("volume", 1,
                [&](std::size_t, std::size_t) { return std::pow(dx, dimensions) * (1.0 + number(random)); });
  body.set_each("mass", 1,
                [&](std::size_t i, std::size_t) { return 2.0 * body["volume"][i] * (1.0 + number(random)); });
  body.set_each("velocity", static_cast<std::size_t>(dimensions),
                [&](std::size_t, std::size_t) { return number(random); });
  return body;
}

double distance(Body& a, std::size_t i, Body& b, std::size_t j) {
  const auto d = static_cast<std::size_t>(a.dimensions());
  double squared = 0.0;
  for (std::size_t k = 0; k < d; ++k)
    squared += std::pow(a["position"][i * d + k] - b["position"][j * d + k], 2);
  return std::sqrt(squared);
}

// sum V K o^2 / 2 over the particles of `own` that see `other`, by plain loops.
double energy(Body& own, Body& other, double touching, double far = 0.0) {
  const auto d = static_cast<std::size_t>(own.dimensions());
  double sum = 0.0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    double colour = 0.0;
    for (std::size_t j = 0; j < other.size(); ++j) {
      double X = 0.0;
      for (std::size_t k = 0; k < d; ++k)
        X += std::pow(own["reference_position"][i * d + k] - other["reference_position"][j * d + k], 2);
      const double r = distance(own, i, other, j);
      if (r < 2.0 * h && (far == 0.0 || X > far * far) && !(&own == &other && i == j))
        colour += other["volume"][j] * W(own.dimensions(), r);
    }
    sum += own["volume"][i] * K * std::pow(std::max(0.0, colour - touching), 2) / 2.0;
  }
  return sum;
}

template <class Pairs, class Op>
void set(Op& op, double far, const char* own, const char* other) {
  if constexpr (requires { op.overlap; }) op.overlap.rename(own);
  if constexpr (requires { op.own_overlap; }) op.own_overlap.rename(own), op.other_overlap.rename(other);
  if constexpr (requires { op.K; }) op.K = K;
  if constexpr (std::is_same_v<Pairs, FarPair>) op.pairs_in_contact.distance = far;
}

// What the physics attaches, on bodies made by hand. Accelerations are added to.
template <class Pairs>
void touch(Body& a, Body& b, double touching, double friction, double far = 0.0) {
  const char* names[] = {"overlap_a", &a == &b ? "overlap_a" : "overlap_b"};
  const char* normals[] = {"normal_a", &a == &b ? "normal_a" : "normal_b"};
  Body* bodies[] = {&a, &b};
  const int sides = &a == &b ? 1 : 2;
  for (int s = 0; s < sides; ++s) {
    ContactOverlap<Pairs> overlap;
    set<Pairs>(overlap, far, names[s], nullptr);
    overlap.touching = touching;
    testing::run(overlap, *bodies[s], {bodies[1 - s]}, setup);
    ContactNormal<Pairs> normal;
    set<Pairs>(normal, far, nullptr, nullptr);
    normal.normal.rename(normals[s]);
    testing::run(normal, *bodies[s], {bodies[1 - s]}, setup);
  }
  for (int s = 0; s < sides; ++s) {
    ContactForce<Pairs> force;
    set<Pairs>(force, far, names[s], names[1 - s]);
    testing::run(force, *bodies[s], {bodies[1 - s]}, setup);
    if (friction == 0.0) continue;
    ContactFriction<Pairs> rub;
    set<Pairs>(rub, far, names[s], names[1 - s]);
    rub.own_normal.rename(normals[s]);
    rub.other_normal.rename(normals[1 - s]);
    rub.friction = friction;
    testing::run(rub, *bodies[s], {bodies[1 - s]}, setup);
  }
}

struct Totals {
  std::array<double, 3> force{}, torque{};
  double size = 0;  // sum of |F|
};
Totals totals(std::vector<Body*> bodies) {
  Totals t;
  for (Body* body : bodies) {
    const auto d = static_cast<std::size_t>(body->dimensions());
    for (std::size_t i = 0; i < body->size(); ++i) {
      std::array<double, 3> x{}, f{};
      for (std::size_t k = 0; k < d; ++k) {
        x[k] = (*body)["position"][i * d + k];
        f[k] = (*body)["mass"][i] * (*body)["acceleration"][i * d + k];
        t.force[k] += f[k];
      }
      for (std::size_t k = 0; k < 3; ++k)
        t.torque[k] += x[(k + 1) % 3] * f[(k + 2) % 3] - x[(k + 2) % 3] * f[(k + 1) % 3];
      t.size += std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    }
  }
  return t;
}

}  // namespace

TEST_CASE("the force of contact is the derivative of the energy of overlaps, and conserves both momenta") {
  for (const int dimensions : {2, 3}) {
    const double touching = contact_scale(dimensions, target_of(), dx, dx).colour_a;
    const auto d = static_cast<std::size_t>(dimensions);
    Body a = block(dimensions, 5, {0.0, 0.0, 0.0}, 0.2 * dx, 1);
    Body b = block(dimensions, 5, {0.03, 5 * dx - 0.6 * dx, 0.02}, 0.2 * dx, 2);
    touch<AnyPair>(a, b, touching, 0.0);
    const Totals sum = totals({&a, &b});
    REQUIRE(sum.size > 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(sum.force[k]) < 1e-14 * sum.size);
      CHECK(std::abs(sum.torque[k]) < 1e-14 * sum.size);
    }
    const auto all = [&] { return energy(a, b, touching) + energy(b, a, touching); };
    std::size_t pressed = 0;
    for (Body* body : {&a, &b})
      for (std::size_t i = 0; i < body->size(); i += 3)
        for (std::size_t k = 0; k < d; ++k) {
          double& x = (*body)["position"][i * d + k];
          const double before = x, step = 1e-6;
          x = before + step;
          const double more = all();
          x = before - step;
          const double less = all();
          x = before;
          const double force = (*body)["mass"][i] * (*body)["acceleration"][i * d + k];
          CHECK(std::abs(force + (more - less) / (2.0 * step)) < 1e-6 * sum.size / double(a.size()));
          pressed += force != 0.0;
        }
    CHECK(pressed > 10);
  }
}

TEST_CASE("a body in contact with itself: near particles are no contact, far ones are, with the same laws") {
  for (const int dimensions : {2, 3}) {
    const double touching = contact_scale(dimensions, target_of(), dx, dx).colour_a;
    const auto d = static_cast<std::size_t>(dimensions);
    // A body whose upper half was folded onto the lower one.
    Body body = block(dimensions, 6, {0, 0, 0}, 0.15 * dx, 3);
    touch<FarPair>(body, body, touching, 0.3, 5.0 * dx);
    CHECK(totals({&body}).size == 0.0);
    for (std::size_t i = 0; i < body.size(); ++i) body["reference_position"][i * d] *= 30.0;
    body["acceleration"].assign(body.size() * d, 0.0);
    touch<FarPair>(body, body, touching, 0.0, 5.0 * dx);
    const Totals sum = totals({&body});
    CHECK(sum.size > 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(sum.force[k]) < 1e-14 * sum.size);
      CHECK(std::abs(sum.torque[k]) < 1e-14 * sum.size);
    }
    for (std::size_t i = 0; i < body.size(); i += 5) {
      double& x = body["position"][i * d];
      const double before = x, step = 1e-6;
      x = before + step;
      const double more = energy(body, body, touching, 5.0 * dx);
      x = before - step;
      const double less = energy(body, body, touching, 5.0 * dx);
      x = before;
      CHECK(std::abs(body["mass"][i] * body["acceleration"][i * d] + (more - less) / (2.0 * step)) <
            1e-6 * sum.size / double(body.size()));
    }
  }
}

TEST_CASE("flat surfaces: no force when they just touch, the stiffness that was asked for, and no bumps") {
  for (const int dimensions : {2, 3}) {
    const ContactScale scale = contact_scale(dimensions, target_of(), dx, dx);
    const auto d = static_cast<std::size_t>(dimensions);
    // The middle column of the upper block, on a lower block that is wide enough: force per area over K.
    const auto pressure = [&](double overlap, double shift) {
      Body lower = block(dimensions, 9, {-0.45, -0.9, -0.45}, 0.0, 1);
      Body upper = block(dimensions, 9, {-0.45 + shift, -overlap, -0.45}, 0.0, 1);
      touch<AnyPair>(lower, upper, scale.colour_a, 0.0);
      double sum = 0.0;
      for (std::size_t i = 0; i < upper.size(); ++i) {
        const auto* x = &upper["position"][i * d];
        if (std::abs(x[0] - shift) < 0.5 * dx && (dimensions == 2 || std::abs(x[2]) < 0.5 * dx))
          sum += upper["mass"][i] * upper["acceleration"][i * d + 1];
      }
      return sum / std::pow(dx, dimensions - 1) / K;
    };
    const double stiffness = scale.stiffness;
    CHECK(std::abs(pressure(0.0, 0.03)) < 0.02 * stiffness);
    CHECK(pressure(-0.1 * dx, 0.03) == 0.0);
    CHECK(pressure(0.1 * dx, 0.03) == doctest::Approx(0.1 * stiffness).epsilon(0.2));
    double least = 1e300, most = 0.0;
    for (int k = 0; k < 5; ++k) {
      const double p = pressure(0.2 * dx, 0.1 * k * dx);
      least = std::min(least, p);
      most = std::max(most, p);
    }
    MESSAGE(dimensions << "D: pressure at an overlap of dx/5 along the surface from " << least / stiffness
                       << " to " << most / stiffness);
    CHECK(most - least < 0.1 * most);
  }
}

TEST_CASE(
    "friction is mu times the normal force when sliding fast, less when slow, and opposite on both bodies") {
  for (const int dimensions : {2, 3}) {
    const double touching = contact_scale(dimensions, target_of(), dx, dx).colour_a, mu = 0.4;
    const auto d = static_cast<std::size_t>(dimensions);
    const auto tangential = [&](double speed) {
      Body lower = block(dimensions, 9, {0, -0.9, 0}, 0.0, 1);
      Body upper = block(dimensions, 9, {0, -0.3 * dx, 0}, 0.0, 1);
      upper.set_each("velocity", d, [&](std::size_t, std::size_t c) { return c == 0 ? speed : 0.0; });
      touch<AnyPair>(lower, upper, touching, mu);
      const Totals sum = totals({&lower, &upper}), above = totals({&upper});
      for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(sum.force[k]) < 1e-14 * sum.size);
      return -above.force[0] / above.force[1];
    };
    CHECK(tangential(100.0) == doctest::Approx(mu).epsilon(0.03));
    CHECK(tangential(-100.0) == doctest::Approx(-mu).epsilon(0.03));
    const double slow = tangential(1e-7);
    CHECK(slow > 0.0);
    CHECK(slow < 0.1 * mu);
  }
}

TEST_CASE("packs and single pairs agree") {
  Body a = block(3, 4, {0, 0, 0}, 0.2 * dx, 4), b = block(3, 4, {0.03, 0.35, 0.01}, 0.2 * dx, 5);
  const double touching = contact_scale(3, target_of(), dx, dx).colour_a;
  touch<AnyPair>(a, b, touching, 0.3);
  ContactFriction<AnyPair> rub;
  set<AnyPair>(rub, 0.0, "overlap_a", "overlap_b");
  rub.own_normal.rename("normal_a");
  rub.other_normal.rename("normal_b");
  rub.friction = 0.3;
  a["acceleration"].assign(a.size() * 3, 0.0);
  testing::run(rub, a, {&b}, setup);
  const auto packs = a["acceleration"];
  a["acceleration"].assign(a.size() * 3, 0.0);
  testing::Setup single = setup;
  single.scalar = true;
  testing::run(rub, a, {&b}, single);
  for (std::size_t k = 0; k < packs.size(); ++k)
    CHECK(a["acceleration"][k] == doctest::Approx(packs[k]).epsilon(1e-12));
}

TEST_CASE("a rigid plane presses on what is nearer than half a spacing, along its normal, with friction") {
  const double normal_length = std::sqrt(0.5);
  PlaneForce plane;
  plane.point = {0.2, 0.1, 0.0};
  plane.normal = {normal_length, normal_length, 0.0};
  plane.modulus = 50.0;
  plane.friction = 0.25;
  Body body(3, {0.2 + 0.3 * dx * normal_length, 0.1 + 0.3 * dx * normal_length, 5.0, 0.9, 0.9, 0.0});
  body.set("volume", 1e-3);
  body.set("mass", 2e-3);
  body.set_each("velocity", 3, [](std::size_t, std::size_t c) { return c == 2 ? 4.0 : 0.0; });
  testing::run(plane, body, {}, setup);
  const double push = 50.0 * 0.2 * dx / (dx * dx) * 1e-3;  // M x / dx dx^2
  const auto& a = body["acceleration"];
  CHECK(a[0] == doctest::Approx(push / 2e-3 * normal_length));
  CHECK(a[1] == doctest::Approx(push / 2e-3 * normal_length));
  CHECK(a[2] == doctest::Approx(-0.25 * push / 2e-3));
  CHECK((a[3] == 0.0 && a[4] == 0.0 && a[5] == 0.0));
}
