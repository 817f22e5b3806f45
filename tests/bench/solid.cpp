// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A block of neo-Hookean rubber in 3D that swings, with about 72 neighbours a particle: particle-steps per second, and
// what hourglass control costs. Two runs of the kernel stand side by side in one process, one of them without the
// control, and take turns of a few steps. Each turn gives a ratio of its own, so that a machine whose speed wanders
// changes both sides of it; their median is printed, with the quartiles beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/app/session.hpp"

using namespace shoal::kernel;

namespace {

// Stress and momentum: what a step does beside moving the particles.
constexpr std::array<std::string_view, 3> passes{"solid.deformation_gradient", "solid.stress",
                                                 "solid.internal_force"};
constexpr std::uint64_t steps_per_turn = 2;

std::string swinging_block(const char* hourglass) {
  return std::string(
             "shoal: 1\n"
             "title: Block of the benchmark\n"
             "plugins: [solid]\n"
             "dimensions: 3\n"
             "parameters: {dx: 1/30}\n"
             "resolution: $dx\n"
             "bodies:\n"
             "  block:\n"
             "    shape: {box: {lower: [0, 0, 0], upper: [1, 1, 1]}}\n"
             "    material: {solid.neo_hookean: {density: 1000, youngs_modulus: 1e7, poisson_ratio: 0.3}}\n"
             "    initial: {velocity: [10*cos(pi*x), 10*cos(pi*y), -10*cos(pi*z)]}\n"
             "physics:\n"
             "  - solid.total_lagrangian: {bodies: [block], support: 2.5, hourglass: ") +
         hourglass + "}\nrun: {end: 100 s}\n";
}

// Seconds of a turn.
struct Turn {
  double passes = 0, steps = 0;
};

class Block {
 public:
  Block(const char* hourglass, int threads) {
    const std::string file = std::string("solid_") + hourglass + ".yaml";
    std::ofstream(file) << swinging_block(hourglass);
    app::Options options;
    options.threads = threads;
    options.plugin_paths = {SHOAL_PLUGINS_FOLDER};
    session_ = std::make_unique<app::Session>(options, file, false);
    session_->run().initialise();
    turn();
  }

  Turn turn() {
    const Turn before = so_far();
    for (std::uint64_t k = 0; k < steps_per_turn; ++k) session_->run().step();
    const Turn after = so_far();
    return {after.passes - before.passes, after.steps - before.steps};
  }
  double particles() const { return static_cast<double>(session_->run().n_particles()); }
  double neighbours() const { return session_->run().plan().relations.at(0).mean_neighbours; }
  double bytes_per_particle() const {
    return static_cast<double>(session_->run().plan().total_bytes) / particles();
  }
  // How far it has swung, m.
  double motion() const {
    const shoal_field x = session_->run().field(0, "position"),
                      X = session_->run().field(0, "reference_position");
    double furthest = 0;
    for (std::uint64_t k = 0; k < 3 * session_->run().n_particles(); ++k)
      furthest = std::max(
          furthest, std::fabs(static_cast<const double*>(x.data)[k] - static_cast<const double*>(X.data)[k]));
    return furthest;
  }

 private:
  Turn so_far() const {
    const Timings timings = session_->run().timings();
    Turn sum{0.0, timings.steps};
    for (const OperatorTiming& op : timings.operators)
      if (std::find(passes.begin(), passes.end(), op.name) != passes.end()) sum.passes += op.seconds;
    return sum;
  }
  std::unique_ptr<app::Session> session_;
};

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

struct Figures {
  std::vector<double> with, without;                    // particle-steps per second
  std::vector<double> ratio_of_passes, ratio_of_steps;  // of each turn
  double particles = 0, neighbours = 0, bytes_per_particle = 0;
};

void take_turns(benchmark::State& state, int threads, Figures& figures) {
  Block controlled("4", threads), free("0", threads);
  bool first = false;
  for (auto _ : state) {
    Turn with, without;
    first = !first;
    if (first) with = controlled.turn();
    without = free.turn();
    if (!first) with = controlled.turn();
    state.SetIterationTime(with.passes / static_cast<double>(steps_per_turn));
    figures.with.push_back(controlled.particles() * steps_per_turn / with.passes);
    figures.without.push_back(free.particles() * steps_per_turn / without.passes);
    figures.ratio_of_passes.push_back(with.passes / without.passes);
    figures.ratio_of_steps.push_back(with.steps / without.steps);
  }
  if (!(controlled.motion() > 0.01) || !(controlled.motion() < 1.0))
    state.SkipWithError("the block does not swing as it should");
  figures.particles = controlled.particles();
  figures.neighbours = controlled.neighbours();
  figures.bytes_per_particle = controlled.bytes_per_particle();
  state.counters["hourglass"] = quantile(figures.ratio_of_passes, 0.5);
  state.counters["particle-steps/s"] = quantile(figures.with, 0.5);
}

void print(const Figures& figures, int threads) {
  const auto line = [&](const char* what, const char* wanted, const std::vector<double>& values,
                        double unit) {
    std::printf("  %-62s %-8s %7.3f  (%.3f to %.3f)\n", what, wanted, quantile(values, 0.5) / unit,
                quantile(values, 0.25) / unit, quantile(values, 0.75) / unit);
  };
  std::printf("\n%.0f particles, %.1f neighbours on average, %d thread(s), %zu turns: median (quartiles)\n",
              figures.particles, figures.neighbours, threads, figures.with.size());
  line("stress and momentum, million particle-steps/s", "", figures.with, 1e6);
  line("stress and momentum with hourglass control / without", "<= 1.15", figures.ratio_of_passes, 1.0);
  std::printf("  %-62s %-8s %7.3f\n", "  the same of their fastest turns", "",
              quantile(figures.without, 1.0) / quantile(figures.with, 1.0));
  line("whole step with hourglass control / without", "", figures.ratio_of_steps, 1.0);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  app::Console::open({});
  std::array<Figures, 2> figures;
  for (const int threads : {1, 2})
    benchmark::RegisterBenchmark(("stress_and_momentum/threads:" + std::to_string(threads)).c_str(),
                                 [&, threads](benchmark::State& state) {
                                   take_turns(state, threads,
                                              figures.at(static_cast<std::size_t>(threads - 1)));
                                 })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(200);
  try {
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  for (const int threads : {1, 2}) {
    const Figures& measured = figures.at(static_cast<std::size_t>(threads - 1));
    if (!measured.with.empty()) print(measured, threads);
  }
  if (figures[0].with.empty() || figures[1].with.empty()) return 0;
  std::printf("\n  two threads faster than one by %.2f; fields and lists: %.0f bytes per particle\n",
              quantile(figures[1].with, 0.5) / quantile(figures[0].with, 0.5), figures[0].bytes_per_particle);
}
