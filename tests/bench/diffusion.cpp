// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// One explicit step of diffusion (rk2: two rates, two updates) against the plain loop that it replaces: all of a pair
// computed anew, one neighbour after the other, fields by name in arrays of doubles. 200 000 particles in 3D, one
// thread, least processor time of ten repetitions that take turns. Both give the same c.
// Then what the parts of a step cost: plugins/diffusion/cost.hpp holds these figures, by which `auto` chooses.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "plugins/diffusion/integrator.hpp"
#include "plugins/diffusion/pairwise.hpp"
#include "tests/bench/scene.hpp"

using namespace shoal;
using namespace shoal::bench;
using namespace shoal::diffusion;

namespace {

double processor_time() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// dc_i/dt = sum_j 2 V_j k_ij (c_i - c_j) W'(r) / (slope r), and Heun's method, as on paper.
class PlainLoop {
 public:
  PlainLoop(const Scene& scene, std::vector<double> x, std::vector<double> volume, std::vector<double> k,
            double slope)
      : list_(scene.list()), x_(std::move(x)), volume_(std::move(volume)), k_(std::move(k)), slope_(slope) {}

  void step(std::vector<double>& c, double dt) {
    const std::vector<double> start = c;
    add_rate(c);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] += dt * rate_[i];
    add_rate(c);
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = 0.5 * (start[i] + c[i] + dt * rate_[i]);
  }

 private:
  void add_rate(const std::vector<double>& c) {
    constexpr double h = Scene::smoothing_length;
    const double factor = 21.0 / (16.0 * std::numbers::pi * h * h * h);
    rate_.assign(c.size(), 0.0);
    for (std::size_t i = 0; i < c.size(); ++i)
      for (std::uint32_t m = 0; m < list_.counts()[i]; ++m) {
        const std::size_t j = list_.indices()[list_.offsets()[i] + m];
        const double dx = x_[3 * i] - x_[3 * j], dy = x_[3 * i + 1] - x_[3 * j + 1],
                     dz = x_[3 * i + 2] - x_[3 * j + 2];
        const double r = std::sqrt(dx * dx + dy * dy + dz * dz), q = r / h;
        if (q >= 2.0) continue;
        const double t = 1.0 - 0.5 * q;
        const double dw = -5.0 * factor / h * q * t * t * t;
        rate_[i] +=
            2.0 * volume_[j] * 2.0 * k_[i] * k_[j] / (k_[i] + k_[j]) * (c[i] - c[j]) * dw / (slope_ * r);
      }
  }

  const kernel::NeighbourList& list_;
  std::vector<double> x_, volume_, k_;
  double slope_;
  std::vector<double> rate_;
};

template <class Op>
void prepare(Op& op, Scene& scene, bool pairs) {
  Target target = scene.target();
  if (!pairs) target.neighbours.clear();
  op.set_target(target);
  op.set_dimensions(3);
  scene.bind(op.accesses(), [&](const shoal_binding& binding) { op.bind(binding); });
}

void run(auto& op, Scene& scene, double time, double dt, double* partial = nullptr) {
  shoal_step step{};
  step.size = sizeof step;
  step.dimensions = 3;
  step.time = time;
  step.dt = step.parent_dt = dt;
  op.set_step(step);
  if constexpr (requires { op.begin(); }) op.begin();
  for (std::uint64_t begin = 0; begin < scene.size(); begin += 256)
    op.template run_chunk<3>({sizeof(shoal_chunk), static_cast<std::uint32_t>(begin / 256), begin,
                              std::min(scene.size(), begin + 256), partial});
}

// Least processor time of ten repetitions over the particles, ns.
double ns_per_particle(auto& op, Scene& scene, double time, double dt) {
  double partial[8] = {}, least = HUGE_VAL;
  for (int repetition = 0; repetition < 10; ++repetition) {
    const double begin = processor_time();
    run(op, scene, time, dt, partial);
    least = std::min(least, processor_time() - begin);
  }
  return 1e9 * least / static_cast<double>(scene.size());
}

// The scene's rows, cut to at most `longest` neighbours and put next to each other again.
class ShortRows {
 public:
  ShortRows(const Scene& scene, std::uint32_t longest) {
    for (std::uint64_t i = 0; i < scene.size(); ++i) {
      const std::uint32_t* row = scene.list().indices() + scene.list().offsets()[i];
      counts_.push_back(std::min(longest, scene.list().counts()[i]));
      offsets_.push_back(indices_.size());
      const std::size_t padded = (counts_.back() + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING;
      for (std::size_t m = 0; m < padded; ++m)
        indices_.push_back(row[std::min<std::size_t>(m, counts_.back() - 1)]);
    }
    list_ = {sizeof(shoal_neighbours),
             0,
             offsets_.data(),
             counts_.data(),
             indices_.data(),
             scene.size(),
             Scene::cutoff,
             1};
  }
  double mean() const {
    double sum = 0;
    for (const std::uint32_t count : counts_) sum += count;
    return sum / static_cast<double>(counts_.size());
  }
  void give(auto& op, Scene& scene) const {
    scene.bind(op.accesses(), [&](shoal_binding binding) {
      binding.neighbours = &list_;
      op.bind(binding);
    });
  }

 private:
  std::vector<std::uint32_t> counts_, indices_;
  std::vector<std::uint64_t> offsets_;
  shoal_neighbours list_{};
};

void print_costs(Scene& scene, const std::shared_ptr<const Stencil>& stencil) {
  ApplyStencil apply;
  apply.set("c", stencil);
  prepare(apply, scene, true);
  double rate[2], neighbours[2];
  for (const std::uint32_t k : {0U, 1U}) {
    const ShortRows rows(scene, k == 0 ? 20 : 1000);
    rows.give(apply, scene);
    rate[k] = ns_per_particle(apply, scene, 0.0, 1e-9);
    neighbours[k] = rows.mean();
  }
  const double per_neighbour = (rate[1] - rate[0]) / (neighbours[1] - neighbours[0]);
  const auto stages = std::make_shared<Stages>();
  stages->step = 1e-9;
  HeunStage heun;
  heun.set("c");
  heun.stages = stages;
  prepare(heun, scene, false);
  SuperStage stage;
  stage.set("c");
  stage.stages = stages;
  prepare(stage, scene, false);
  stages->number = 5;
  stages->super = true;
  const double of_heun = ns_per_particle(heun, scene, 0.0, 1e-9);
  const double of_stage = ns_per_particle(stage, scene, 0.4e-9, 0.2e-9);
  const double of_last = ns_per_particle(stage, scene, 0.8e-9, 0.2e-9);
  std::printf("costs of the parts of a step, ns per particle\n");
  std::printf("  rate: %.2f per neighbour and %.1f per particle\n", per_neighbour,
              rate[0] - per_neighbour * neighbours[0]);
  std::printf("  a stage of rk2 %.2f, of rkl2 %.2f, its error at the end of a step %.2f\n", of_heun, of_stage,
              of_last - of_stage);
}

}  // namespace

int main() {
  Scene scene;
  const std::size_t n = scene.size();
  double *c = scene.field("c", 1), *k = scene.field("c_conductivity", 1), *volume = scene.field("volume", 1);
  const double* x = scene.field("position", 3);
  for (std::size_t i = 0; i < n; ++i) {
    c[i] = std::sin(20.0 * x[3 * i]) * std::cos(15.0 * x[3 * i + 1]);
    k[i] = 1.0 + 0.5 * std::sin(10.0 * x[3 * i + 2]);
    volume[i] = std::pow(Scene::dx, 3);
  }
  std::vector<double> plain_c(c, c + n);
  double slope = 0;
  with_kernel<3>(scene.target().smoothing_kernel, Scene::smoothing_length,
                 [&](const auto& kernel) { slope = LatticeMoments<3>(kernel, Scene::dx).slope(); });
  PlainLoop plain(scene, {x, x + 3 * n}, {volume, volume + n}, {k, k + n}, slope);

  const auto stencil = std::make_shared<Stencil>();
  stencil->motions.push_back(std::make_shared<Motion>());
  stencil->seen = {7};
  PairwiseWeights weights;
  weights.set("c", true, stencil);
  weights.moving = true;
  prepare(weights, scene, true);
  weights.begin();
  std::vector<double> partial(weights.reductions().size());
  const double weights_begin = processor_time();
  for (std::uint64_t begin = 0; begin < n; begin += 256)
    weights.run_chunk<3>({sizeof(shoal_chunk), static_cast<std::uint32_t>(begin / 256), begin,
                          std::min<std::uint64_t>(n, begin + 256), partial.data()});
  const double weights_seconds = processor_time() - weights_begin;
  ApplyStencil apply;
  apply.set("c", stencil);
  prepare(apply, scene, true);
  const auto stages = std::make_shared<Stages>();
  HeunStage heun;
  heun.set("c");
  heun.stages = stages;
  prepare(heun, scene, false);

  const double dt = 1e-6;
  double least_plain = HUGE_VAL, least_ours = HUGE_VAL;
  for (int repetition = 0; repetition < 10; ++repetition) {
    double begin = processor_time();
    plain.step(plain_c, dt);
    least_plain = std::min(least_plain, processor_time() - begin);
    begin = processor_time();
    stages->step = dt;
    stages->start = 0;
    for (const double time : {0.0, 0.5 * dt}) {
      double* rate = scene.field("c_rate", 1);
      std::fill(rate, rate + n, 0.0);
      run(apply, scene, time, 0.5 * dt);
      run(heun, scene, time, 0.5 * dt);
    }
    least_ours = std::min(least_ours, processor_time() - begin);
  }
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(c[i] - plain_c[i]));
  if (!(worst < 1e-12)) throw std::runtime_error("the two loops differ by " + std::to_string(worst));

  const double pairs = 2.0 * static_cast<double>(scene.n_pairs());
  std::printf("%zu particles, %.1f neighbours, one thread, one step of rk2\n", n,
              0.5 * pairs / static_cast<double>(n));
  std::printf("  plain scalar loop               %8.2f ms  %6.2f ns per pair\n", 1e3 * least_plain,
              1e9 * least_plain / pairs);
  std::printf("  diffusion.diffusion             %8.2f ms  %6.2f ns per pair\n", 1e3 * least_ours,
              1e9 * least_ours / pairs);
  std::printf("  faster by (wanted >= 3)         %8.2f\n", least_plain / least_ours);
  std::printf("  weights, once                   %8.2f ms\n", 1e3 * weights_seconds);
  print_costs(scene, stencil);
}
