// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The speeds that the design rests on, measured side by side in one run and printed as ratios. Times are those of the
// thread's own processor time, the least of several repetitions that take turns, since what else runs on a machine
// only ever adds. Only the scaling over threads needs an idle machine: what two threads that share nothing gain is printed
// beside it.
#include <benchmark/benchmark.h>
#include <dlfcn.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "plugins/fluid/riemann.hpp"
#include "tests/bench/eigen_loop.hpp"
#include "tests/bench/program.hpp"
#include "tests/bench/scene.hpp"

using namespace shoal;
using namespace shoal::bench;

namespace {

shoal_step one_step() {
  shoal_step step{};
  step.size = sizeof step;
  step.dimensions = 3;
  step.dt = step.parent_dt = 1e-4;
  return step;
}

// An operator compiled into this program, over all particles at once: no call that could be saved is left.
template <class Op>
class Linked {
 public:
  explicit Linked(Scene& scene) : scene_(scene) {
    op.set_target(scene.target());
    op.set_dimensions(3);
    scene.bind(op.accesses(), [&](const shoal_binding& binding) { op.bind(binding); });
    op.set_step(one_step());
  }
  void run() const { op.template run_chunk<3>({sizeof(shoal_chunk), 0, 0, scene_.size(), nullptr}); }
  Op op;

 private:
  Scene& scene_;
};

// The same as the kernel sees it.
class Plugged {
 public:
  explicit Plugged(Scene& scene) : scene_(scene) {
    void* library = dlopen(SHOAL_BENCH_MODULE, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
    using Make = shoal_operator (*)(double, double, Constants);
    op_ = reinterpret_cast<Make>(dlsym(library, "bench_operator"))(Scene::smoothing_length, Scene::cutoff,
                                                                   scene.constants());
    scene.bind({op_.accesses, op_.accesses + op_.n_accesses},
               [&](const shoal_binding& binding) { check(op_.bind(op_.self, &binding)); });
  }
  Plugged(const Plugged&) = delete;
  Plugged& operator=(const Plugged&) = delete;
  ~Plugged() { op_.destroy(op_.self); }
  void run() const {
    constexpr std::uint64_t chunk_size = 128;
    check(op_.begin(op_.self, &step_));
    for (std::uint64_t begin = 0; begin < scene_.size(); begin += chunk_size) {
      const shoal_chunk chunk{sizeof(shoal_chunk), static_cast<std::uint32_t>(begin / chunk_size), begin,
                              std::min(scene_.size(), begin + chunk_size), nullptr};
      check(op_.run(op_.self, &step_, &chunk));
    }
    check(op_.end(op_.self, &step_, nullptr));
  }

 private:
  static void check(shoal_status status) {
    if (status != SHOAL_OK) throw std::runtime_error("a callback of the module failed");
  }
  Scene& scene_;
  shoal_step step_ = one_step();
  shoal_operator op_{};
};

EigenFluid eigen_fluid(Scene& scene) {
  EigenFluid fluid;
  const double *x = scene.field("position", 3), *v = scene.field("velocity", 3);
  const double *rho = scene.field("density", 1), *p = scene.field("pressure", 1);
  for (std::uint64_t i = 0; i < scene.size(); ++i) {
    fluid.position.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    fluid.velocity.emplace_back(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
  }
  fluid.density.assign(rho, rho + scene.size());
  fluid.pressure.assign(p, p + scene.size());
  fluid.acceleration.resize(scene.size());
  fluid.density_rate.resize(scene.size());
  return fluid;
}

// Largest difference of the operator's results from those of the Eigen loop, relative to their largest.
double difference(Scene& scene, const EigenFluid& fluid) {
  const double *a = scene.field("pressure_acceleration", 3), *rate = scene.field("density_rate", 1);
  double largest_a = 0, largest_rate = 0, worst_a = 0, worst_rate = 0;
  for (std::uint64_t i = 0; i < scene.size(); ++i) {
    const Eigen::Vector3d mine(a[3 * i], a[3 * i + 1], a[3 * i + 2]);
    largest_a = std::max(largest_a, fluid.acceleration[i].norm());
    worst_a = std::max(worst_a, (mine - fluid.acceleration[i]).norm());
    largest_rate = std::max(largest_rate, std::abs(fluid.density_rate[i]));
    worst_rate = std::max(worst_rate, std::abs(rate[i] - fluid.density_rate[i]));
  }
  return std::max(worst_a / largest_a, worst_rate / largest_rate);
}

// Remembers the least time of each benchmark.
class Reporter : public benchmark::ConsoleReporter {
 public:
  Reporter() : ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration) {
        const double seconds = run.cpu_accumulated_time / static_cast<double>(run.iterations);
        const auto at = least_.try_emplace(run.run_name.function_name, seconds).first;
        at->second = std::min(at->second, seconds);
      }
  }
  double seconds(const char* name) const { return least_.at(name); }

 private:
  std::map<std::string, double> least_;
};

template <class Work>
void add(const char* name, const Work& work) {
  benchmark::RegisterBenchmark(name,
                               [work](benchmark::State& state) {
                                 for (auto _ : state) work();
                               })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(1)
      ->Repetitions(30)
      ->ReportAggregatesOnly(false);
}

void line(const char* what, const char* wanted, double measured, const char* unit) {
  std::printf("  %-68s %-10s %8.3f %s\n", what, wanted, measured, unit);
}

void measure_loops(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  Scene scene;
  EigenFluid fluid = eigen_fluid(scene);
  Linked<OnePass> linked(scene);
  linked.op.constants = scene.constants();
  const Plugged plugged(scene);

  eigen_loop(fluid, scene.list(), Scene::smoothing_length, scene.constants());
  for (const bool from_module : {false, true}) {
    scene.clear_results();
    from_module ? plugged.run() : linked.run();
    const double d = difference(scene, fluid);
    if (!(d < 1e-11))
      throw std::runtime_error("the pair loop and the Eigen loop differ by " + std::to_string(d));
  }

  Linked<fluid::PressureForce> pressure(scene);
  pressure.op.reference_density = scene.constants().reference_density;
  pressure.op.sound_speed = scene.constants().sound_speed;
  Linked<fluid::VelocityDivergence> velocity(scene);
  velocity.op.reference_density = scene.constants().reference_density;
  velocity.op.sound_speed = scene.constants().sound_speed;

  add("eigen", [&] { eigen_loop(fluid, scene.list(), Scene::smoothing_length, scene.constants()); });
  add("linked", [&] { linked.run(); });
  add("plugged", [&] { plugged.run(); });
  add("pressure_force", [&] { pressure.run(); });
  add("velocity_divergence", [&] { velocity.run(); });
  // The lists come out the same, so that what the operators were bound to stays valid.
  add("rebuild", [&] { scene.rebuild(); });

  benchmark::Initialize(&argc, argv);
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);

  const double pairs = static_cast<double>(scene.n_pairs());
  const auto per_pair = [&](const char* name) { return 1e9 * reporter.seconds(name) / pairs; };
  std::printf("\n%llu particles, %.1f neighbours on average, %d lanes, one thread\n",
              static_cast<unsigned long long>(scene.size()), pairs / static_cast<double>(scene.size()),
              RealTraits<Pack>::lanes);
  std::printf("  %-68s %-10s %8s\n", "", "wanted", "measured");
  line("pair loop of the SDK: faster than the Eigen loop by", ">= 4", per_pair("eigen") / per_pair("linked"),
       "");
  line("  pair loop of the SDK", "< 3", per_pair("linked"), "ns per pair");
  line("  Eigen loop", "", per_pair("eigen"), "ns per pair");
  line("  fluid.pressure_force", "", per_pair("pressure_force"), "ns per pair");
  line("  fluid.divergence", "", per_pair("velocity_divergence"), "ns per pair");
  line("through the boundary of plugins / linked in", "<= 1.02", per_pair("plugged") / per_pair("linked"),
       "");
  line("neighbour search / pass of momentum and continuity", "<= 1.5",
       reporter.seconds("rebuild") / reporter.seconds("linked"), "");
  line("neighbour search / the fluid's two passes", "",
       reporter.seconds("rebuild") /
           (reporter.seconds("pressure_force") + reporter.seconds("velocity_divergence")),
       "");
  std::fflush(stdout);
}

void keep_least(std::optional<Cost>& best, const Cost& cost) {
  if (!best || cost.steps_seconds < best->steps_seconds) best = cost;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// How much more two threads that share nothing get done than one: 2 where each has a core of its own, less on machines
// that share theirs with others.
double gain_of_two_threads() {
  const auto spin = [] {
    volatile double x = 1.0;
    for (int k = 0; k < 20'000'000; ++k) x = x * 0.999 + 0.001;
  };
  double one = 1e300, two = 1e300;
  for (int k = 0; k < 3; ++k) {
    one = std::min(one, seconds_of(spin));
    two = std::min(two, seconds_of([&] {
                     std::thread other(spin);
                     spin();
                     other.join();
                   }));
  }
  return 2.0 * one / two;
}

void measure_program() {
  std::optional<Cost> least_small, least_one, least_two;
  for (int k = 0; k < 3; ++k) keep_least(least_small, run_dam_break(3000, 200, 1));
  const double gain_before = gain_of_two_threads();
  for (int k = 0; k < 4; ++k) {  // in turns, so that a disturbance does not hit one of them alone
    keep_least(least_one, run_dam_break(100000, 6, 1));
    keep_least(least_two, run_dam_break(100000, 6, 2));
  }
  const Cost small = *least_small, one = *least_one, two = *least_two;
  std::printf("\nwhole program, dam break in 3D, least of several turns\n");
  line("steps of 100k particles of water: two threads faster than one by", ">= 1.8",
       one.steps_seconds / two.steps_seconds, "");
  line("  two threads that share nothing, before and after", "2", gain_before, "");
  line("", "2", gain_of_two_threads(), "");
  line("share outside operators and neighbour search, 3k particles", "<= 0.08",
       small.overhead_seconds / small.steps_seconds, "");
  line("share outside operators and neighbour search, 100k, one thread", "<= 0.08",
       one.overhead_seconds / one.steps_seconds, "");
  line("share outside operators and neighbour search, 100k, two threads", "<= 0.08",
       two.overhead_seconds / two.steps_seconds, "");
  line("particle-steps per acoustic step, one thread", "", 1e-6 * one.particle_steps_per_second, "million/s");
  line("particle-steps per acoustic step, two threads", "", 1e-6 * two.particle_steps_per_second,
       "million/s");
  line("memory of fields and lists", "", one.bytes_per_particle, "bytes per particle");
  line("start of a case of 3k particles until its first step", "<= 0.15", small.startup_seconds, "s");
}

}  // namespace

int main(int argc, char** argv) {
  // Repetitions of all take turns, so that a disturbance does not hit one of them alone.
  std::vector<char*> arguments(argv, argv + argc);
  std::string take_turns = "--benchmark_enable_random_interleaving=true";
  arguments.insert(arguments.begin() + 1, take_turns.data());
  arguments.push_back(nullptr);
  try {
    measure_loops(argc + 1, arguments.data());
    measure_program();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
