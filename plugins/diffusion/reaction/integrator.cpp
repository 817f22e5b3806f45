// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "integrator.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "shoal/pack.hpp"
#include "shoal/pack_math.hpp"

namespace shoal::diffusion {
namespace {

constexpr std::uint64_t padded(std::uint64_t n) {
  return (n + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING;
}

// An array for each variable, aligned: packs that cross lines of the cache are stored at a quarter of the speed.
class Columns {
 public:
  // n a multiple of SHOAL_PADDING.
  void resize(std::size_t n_variables, std::uint64_t n) {
    if (values_.size() == n_variables * n + SHOAL_PADDING) return;
    values_.resize(n_variables * n + SHOAL_PADDING);
    pointers_.resize(n_variables);
    void* begin = values_.data();
    std::size_t room = values_.size() * sizeof(double);
    std::align(SHOAL_PADDING * sizeof(double), n_variables * n * sizeof(double), begin, room);
    for (std::size_t v = 0; v < n_variables; ++v) pointers_[v] = static_cast<double*>(begin) + v * n;
  }
  double* operator[](std::size_t v) const { return pointers_[v]; }
  double* const* all() const { return pointers_.data(); }

 private:
  std::vector<double> values_;
  std::vector<double*> pointers_;
};

}  // namespace

// Scratch of one thread.
struct ReactionIntegrator::Work {
  Columns q, p, middle, end, state;
  std::vector<double> error, source, position;
  std::vector<double*> block_y;
  std::vector<std::uint32_t> rejected, group;
  std::vector<std::uint64_t> kept_at;

  void resize(std::size_t n_variables, std::uint64_t block, std::size_t dimensions) {
    for (Columns* columns : {&q, &p, &middle, &end, &state}) columns->resize(n_variables, block);
    error.resize(block);
    source.resize(block);
    position.resize(block * dimensions);
    block_y.resize(n_variables);
  }
};

ReactionIntegrator::ReactionIntegrator(Interface<shoal_reaction_model> model, bool adaptive)
    : model_(model), adaptive_(adaptive) {
  n_ = model_.api->variables(model_.self, &variables_);
  if (n_ == 0) throw shoal::impl::HostFailed(SHOAL_CASE_ERROR);
  // The scratch of a block, five numbers for each variable, stays in the nearest cache.
  block_ = std::clamp<std::uint64_t>(32768 / (5 * sizeof(double) * n_) / 8 * 8, 16, 256);
}

void ReactionIntegrator::advance(int dimensions, double t, double dt, std::uint64_t n, const double* position,
                                 double* const* y, const double* source) const {
  std::vector<double*> block(n_);
  for (std::uint64_t first = 0; first < n; first += block_) {
    for (std::size_t v = 0; v < n_; ++v) block[v] = y[v] + first;
    advance_block(dimensions, t, dt, std::min(block_, n - first),
                  position + first * static_cast<std::uint64_t>(dimensions), block.data(),
                  source ? source + first : nullptr);
  }
}

// From y to w.end; w.error becomes the largest of its entries and of this step's, in units of the tolerances.
void ReactionIntegrator::step(Work& w, int dimensions, double t, double dt, std::uint64_t n,
                              const double* position, const double* const* y, const double* source) const {
  const auto width = static_cast<std::uint64_t>(lanes);
  const auto rates_of = [&](const double* const* state, double time) {
    check_host(model_.api->rates(model_.self, dimensions, time, n, position, state, w.q.all(), w.p.all()));
    if (source)
      for (std::uint64_t i = 0; i < n; ++i) w.q[0][i] += source[i];
  };
  rates_of(y, t);
  for (std::size_t v = 0; v < n_; ++v) {
    for (std::uint64_t i = 0; i < n; i += width) {
      const Pack start = Pack::load(y[v] + i), p = Pack::load(w.p[v] + i);
      const Pack change =
          0.5 * dt * (Pack::load(w.q[v] + i) - p * start) * reciprocal(1.0 + 0.5 * dt * max(0.0, p));
      (start + change).store(w.middle[v] + i);
      (start + 2.0 * change).store(w.end[v] + i);
    }
  }
  rates_of(w.middle.all(), t + 0.5 * dt);
  for (std::size_t v = 0; v < n_; ++v) {
    const double tolerance = adaptive_ ? variable(v).tolerance : 0.0;
    for (std::uint64_t i = 0; i < n; i += width) {
      const auto whole = relaxation(Pack::load(w.p[v] + i) * dt);
      const Pack end = Pack::load(y[v] + i) * whole.decay + Pack::load(w.q[v] + i) * dt * whole.mean;
      if (tolerance > 0.0) {
        const Pack error = abs(end - Pack::load(w.end[v] + i)) * (1.0 / tolerance);
        max(error, Pack::load(w.error.data() + i)).store(w.error.data() + i);
      }
      end.store(w.end[v] + i);
    }
  }
}

void ReactionIntegrator::advance_block(int dimensions, double t, double dt, std::uint64_t n,
                                       const double* position, double* const* y, const double* source) const {
  static thread_local Work w;
  w.resize(n_, block_, static_cast<std::size_t>(dimensions));
  std::fill(w.error.begin(), w.error.end(), 0.0);
  step(w, dimensions, t, dt, n, position, y, source);
  w.rejected.clear();
  for (std::uint64_t i = 0; i < n; ++i) {
    if (w.error[i] > 1.0) {
      w.rejected.push_back(static_cast<std::uint32_t>(i));
    } else {
      for (std::size_t v = 0; v < n_; ++v) y[v][i] = w.end[v][i];
    }
  }
  if (!w.rejected.empty()) refine(w, dimensions, t, dt, position, y, source);
}

// Repeats the step of the particles in w.rejected with 2, 4, ... smaller ones until their errors are small enough.
void ReactionIntegrator::refine(Work& w, int dimensions, double t, double dt, const double* position,
                                double* const* y, const double* source) const {
  const auto d = static_cast<std::uint64_t>(dimensions);
  for (int halvings = 1; !w.rejected.empty(); ++halvings) {
    w.group.swap(w.rejected);
    w.rejected.clear();
    const std::uint64_t n = w.group.size();
    for (std::uint64_t g = 0; g < n; ++g) {
      const std::uint32_t i = w.group[g];
      for (std::size_t v = 0; v < n_; ++v) w.state[v][g] = y[v][i];
      for (std::uint64_t a = 0; a < d; ++a) w.position[g * d + a] = position[i * d + a];
      w.source[g] = source ? source[i] : 0.0;
    }
    std::fill(w.error.begin(), w.error.end(), 0.0);
    const int steps = 1 << halvings;
    for (int k = 0; k < steps; ++k) {
      step(w, dimensions, t + k * (dt / steps), dt / steps, n, w.position.data(), w.state.all(),
           w.source.data());
      for (std::size_t v = 0; v < n_; ++v) std::copy_n(w.end[v], padded(n), w.state[v]);
    }
    for (std::uint64_t g = 0; g < n; ++g) {
      if (w.error[g] > 1.0 && halvings < max_halvings)
        w.rejected.push_back(w.group[g]);
      else
        for (std::size_t v = 0; v < n_; ++v) y[v][w.group[g]] = w.state[v][g];
    }
  }
}

}  // namespace shoal::diffusion
