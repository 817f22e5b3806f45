// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Soft grains that fall on a floor: a small physics with everything that the program has to handle (neighbours, a
// time step that depends on the particles, a field on demand, a failure), so that it is tested without the real ones.
//
//   dv_i/dt = g + (k / m) sum_j max(0, 1 - r / r_c) e_ij - c v_i        semi-implicit Euler
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <thread>

#include "shoal/shoal.hpp"

namespace grains {

using namespace shoal;

struct Matter : Material {
  Param<double> density{"density", "kg/m3", "Density.", positive, default_to(1000.0), example("800")};
};

struct SetMass : ParticleOperator<SetMass> {
  double density = 0;
  In<Scalar> volume{"volume"};
  Out<Scalar> mass{"mass"};
  void particle(auto i) const { mass[i] = density * volume[i]; }
};

struct Repulsion : PairOperator<Repulsion> {
  double stiffness = 0, reach = 0;
  In<Scalar> mass{"mass", own_only};
  Accumulate<Vector> acceleration{"acceleration"};

  auto pair(const auto& p) const { return max(0.0, 1.0 - p.r() / reach) * p.e(); }
  void particle(auto i, auto sum) const { acceleration[i] += stiffness / mass[i] * sum; }
};

struct Weight : ParticleOperator<Weight> {
  Vector3 gravity{};
  Accumulate<Vector> acceleration{"acceleration"};
  void particle(auto i) const {
    for (std::size_t k = 0; k < static_cast<std::size_t>(i.dimensions); ++k)
      acceleration[i][static_cast<int>(k)] += gravity[k];
  }
};

struct Move : ParticleOperator<Move> {
  double damping = 0, floor = 0, longest_step = 0, breakdown = 0;
  In<Vector> acceleration{"acceleration"};
  InOut<Vector> velocity{"velocity"};
  InOut<Vector> position{"position"};

  void particle(auto i) const {
    velocity[i] += dt() * (acceleration[i] - damping * velocity[i]);
    if (position[i][1] < floor && velocity[i][1] < 0.0) velocity[i][1] = -velocity[i][1];
    position[i] += dt() * velocity[i];
    if (time() >= breakdown && i.index == 3) velocity[i][0] = std::numeric_limits<double>::quiet_NaN();
  }
  double time_step_of(auto i) const {
    const double speed = std::sqrt(squared_norm(velocity[i]));
    return std::min(longest_step, 0.1 * smoothing_length() / (speed + 1e-12));
  }
};

struct KineticEnergy : ParticleOperator<KineticEnergy> {
  In<Vector> velocity{"velocity"};
  In<Scalar> mass{"mass"};
  Out<Scalar> kinetic_energy{"kinetic_energy", unit("J"), doc("Kinetic energy of a particle."), derived};
  void particle(auto i) const { kinetic_energy[i] = 0.5 * mass[i] * squared_norm(velocity[i]); }
};

class Falling : public Physics {
 public:
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies of grains.", example("[pile]")};
  Param<double> stiffness{"stiffness", "N", "Force between two grains at the same place.", non_negative,
                          default_to(50.0)};
  Param<double> damping{"damping", "1/s", "Rate at which velocities decay.", non_negative, default_to(0.0)};
  Param<double> floor{"floor", "m", "Height of the floor.", default_to(0.0)};
  Param<double> longest_step{"longest_step", "s", "No step is longer.", positive, default_to(1e-3)};
  Param<double> step_factor{
      "step_factor",   "1", "Longest step over 1 / damping. Stable below 2.", positive, default_to(1.0),
      scales_time_step};
  Param<double> breakdown{"breakdown", "s", "From then on a velocity is not a number.", optional};

  void build(const Builder& builder) const {
    builder.loop("motion", {"forces", "move"});
    builder.renew_neighbours_in("motion");
    for (const BodyIndex body : bodies.value()) build(builder, body);
    builder.note("grains of stiffness " + std::to_string(stiffness.value()) + " N");
  }

 private:
  void build(const Builder& builder, BodyIndex body) const {
    const Target target = builder.target(body);
    const double density = builder.material<Matter>(body, "grains.matter")->density;
    builder.body_moves(body);
    builder.own_field(body, "acceleration", {"motion", "forces"});
    builder.guard(body, "velocity", -1e3, 1e3);
    builder.attach<SetMass>("grains.set_mass", {SHOAL_INITIAL, "mass"}, target,
                            [&](SetMass& op) { op.density = density; });
    builder.attach<Weight>("grains.weight", {"motion", "forces"}, target,
                           [&](Weight& op) { op.gravity = builder.gravity(); });
    builder.attach<Repulsion>("grains.repulsion", {"motion", "forces"}, target, [&](Repulsion& op) {
      op.stiffness = stiffness;
      op.reach = target.cutoff;
    });
    builder.attach<Move>("grains.move", {"motion", "move"}, target, [&](Move& op) {
      op.damping = damping;
      op.floor = floor;
      op.longest_step =
          damping > 0.0 ? std::min(longest_step.value(), step_factor / damping) : longest_step.value();
      op.breakdown = breakdown.value_or(std::numeric_limits<double>::infinity());
    });
    builder.attach<KineticEnergy>(
        "grains.kinetic_energy", {SHOAL_SAMPLE, "energy"}, target, [](KineticEnergy&) {},
        SHOAL_OPERATOR_ON_DEMAND);
  }
};

// A table for each snapshot, renamed into place; optionally slow, so that a kill meets it at work.
class Tables final : public Output {
 public:
  void begin(const Run& run) override {
    folder_ = run.folder;
    for (std::uint64_t k = run.resumed_sequence; std::filesystem::remove(file(k)); ++k) {
    }
  }
  void write(const shoal_snapshot& snapshot) override {
    const std::filesystem::path part = folder_ / "part";
    std::ofstream stream(part);
    stream.precision(17);
    for (const shoal_snapshot_body& body : bodies_of(snapshot)) {
      stream << body.name << ' ' << snapshot.time << ' ' << body.n_particles;
      for (const shoal_snapshot_field& field : fields_of(body))
        stream << ' ' << field.name << ':' << field.components;
      stream << '\n';
      std::this_thread::sleep_for(std::chrono::duration<double>(pause.value()));
      for (std::uint64_t i = 0; i < body.n_particles; ++i) {
        stream << body.id[i] << ' ' << body.position[2 * i] << ' ' << body.position[2 * i + 1] << '\n';
      }
    }
    stream << "end\n";
    stream.close();
    std::filesystem::rename(part, file(snapshot.sequence));
  }

 private:
  std::filesystem::path file(std::uint64_t sequence) const {
    return folder_ / (std::to_string(sequence) + ".txt");
  }
  Param<double> pause{"pause", "s", "Time that writing takes.", non_negative, default_to(0.0)};
  std::filesystem::path folder_;
};

// Centre of mass of a body.
class Centre final : public Probe {
 public:
  Param<BodyName> body{"body", nullptr, "Body whose centre is wanted.", example("pile")};
  Param<std::string> field{"field", nullptr, "What particles are weighted with.", default_to("mass")};
  std::vector<Column> columns() const override { return {{"x", "m"}, {"y", "m"}, {"weight", "kg"}}; }
  std::vector<Need> needs() const override { return {{body->name, field.value()}}; }
  void sample(const shoal_snapshot& snapshot, double* values) override {
    const shoal_snapshot_body& found = *find_body(snapshot, body->name);
    const auto* weight = static_cast<const double*>(find_field(found, field.value())->data);
    double x = 0, y = 0, sum = 0;
    for (std::uint64_t i = 0; i < found.n_particles; ++i) {
      x += weight[i] * found.position[2 * i];
      y += weight[i] * found.position[2 * i + 1];
      sum += weight[i];
    }
    if (!(sum > 0)) throw PhysicsFailed("nothing has a weight");
    values[0] = x / sum;
    values[1] = y / sum;
    values[2] = sum;
  }
};

}  // namespace grains

SHOAL_PLUGIN(grains, "1.0.0") {
  summary("Soft grains, to test the program with.");
  add<grains::Matter>("grains.matter", "What grains are made of.");
  add<grains::Falling>("grains.falling", "Grains that fall on a floor.");
  add<grains::Centre>("grains.centre", "Centre of mass.");
  add<grains::Tables>("grains.tables", "The particles as text.");
}
