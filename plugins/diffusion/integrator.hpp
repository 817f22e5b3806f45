// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Time integration of one step of the loop `diffusion` in stages, each of which is a step of a loop inside it: rates
// are summed up by whatever adds to <field>_rate, then c moves on.
//
// rk2    Heun's method (Shu, Osher 1988):  c1 = c0 + dt L(c0),  c = (c0 + c1 + dt L(c1)) / 2
//        Stable for dt <= 2 / lambda, lambda the largest eigenvalue of -L.
// rkl2   Super time steps of s stages on Legendre polynomials (Meyer, Balsara, Aslam 2014, J. Comput. Phys. 257, 594):
//          Y1 = Y0 + m~1 dt L(Y0)
//          Yj = mj Yj-1 + nj Yj-2 + (1 - mj - nj) Y0 + m~j dt L(Yj-1) + g~j dt L(Y0)
//        Second order, stable for dt <= (s^2 + s - 2) / (2 lambda), so that a step s^2 / 4 times as long costs s / 2
//        times as much. s is odd, which damps the highest modes most.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "shoal/particle_operator.hpp"
#include "species.hpp"

namespace shoal::diffusion {

// b_j of rkl2, and the time of Y_j over the step, j = 0 ... s
struct Legendre {
  int s;

  static double b(int j) { return j < 2 ? 1.0 / 3.0 : (j * j + j - 2.0) / (2.0 * j * (j + 1.0)); }
  double w1() const { return 4.0 / (s * s + s - 2.0); }
  double time(int j) const {
    return j == 0 ? 0.0 : j == 1 ? b(1) * w1() : (j * j + j - 2.0) / (s * s + s - 2.0);
  }
  // Stages for a step of dt: the smallest odd number that is stable.
  static int stages(double dt_times_lambda) {
    const int least =
        static_cast<int>(std::ceil(0.5 * (std::sqrt(9.0 + 8.0 * dt_times_lambda) - 1.0) - 1e-9));
    return std::max(3, least % 2 == 0 ? least + 1 : least);
  }
  // Largest lambda dt with s stages.
  static double reach(int s) { return 0.5 * (s * s + s - 2.0); }
};

// What the operators of one field share in a step.
struct Stages {
  bool super = false;  // rkl2, else rk2
  int number = 2;      // of stages in this step
  double step = 0;     // s, the whole step
  double start = 0;    // s, time at its beginning
  // Of the last step of rkl2, over all bodies: its length in s, and what its error and the range of c are made of.
  double measured_step = 0;
  double squares = 0, particles = 0, lowest = HUGE_VAL, highest = -HUGE_VAL;

  // Error of the last step, root mean square over the range of c; negative: not known.
  double error() const {
    if (particles == 0.0) return -1.0;
    return highest > lowest ? std::sqrt(squares / particles) / (highest - lowest) : 0.0;
  }
  void forget_error() { squares = particles = 0.0, lowest = HUGE_VAL, highest = -HUGE_VAL; }

  // 1, 2, ...: the stage that a step of the inner loop is.
  int current(const shoal_step& inner) const {
    return 1 + static_cast<int>(std::lround((inner.time - start) / step * number));
  }
  // Time at which the rate of stage `inner` is taken, s.
  double time_of(const shoal_step& inner) const {
    const int j = current(inner);
    return start + step * (super ? Legendre{number}.time(j - 1) : j == 1 ? 0.0 : 1.0);
  }
};

// Divides the step into stages: the inner loop follows its limit.
struct InnerStep : ParticleOperator<InnerStep> {
  std::shared_ptr<const Stages> stages;
  double time_step(double) const { return stages->step / stages->number; }
};

struct HeunStage : ParticleOperator<HeunStage> {
  InOut<Scalar> value{"value"};
  InOut<Scalar> start{"start", doc("Value at the beginning of the step."), derived};
  In<Scalar> rate{"rate"};

  std::shared_ptr<const Stages> stages;
  Names names;

  void set(const std::string& field) {
    value.rename(names.keep(field));
    start.rename(names.keep(start_of(field)));
    rate.rename(names.keep(rate_of(field)));
  }
  void begin() { first_ = stages->current(step()) == 1; }
  void block(std::uint64_t begin, std::uint64_t end) const {
    double* c = value.data();
    double* c0 = start.data();
    const double* l = rate.data();
    const double dt = stages->step;
    if (first_)
      for (std::uint64_t i = begin; i < end; ++i) {
        c0[i] = c[i];
        c[i] += dt * l[i];
      }
    else
      for (std::uint64_t i = begin; i < end; ++i) c[i] = 0.5 * (c0[i] + c[i] + dt * l[i]);
  }

 private:
  bool first_ = true;
};

// A stage of rk2 or of rkl2, as `stages` says for the step, with an estimate of the error of the step at its end:
//   e = c - c0 - dt (L0 + (Lc - L0) / (2 t)),   Lc the rate of the last stage but one, at time t dt
// of third order in dt, as the error of the step itself.
struct SuperStage : ParticleOperator<SuperStage> {
  InOut<Scalar> value{"value"};
  InOut<Scalar> start{"start", doc("Value at the beginning of the step."), derived};
  InOut<Scalar> start_rate{"start_rate", doc("Rate at the beginning of the step."), derived};
  InOut<Scalar> previous{"previous", doc("Value one stage before."), derived};
  In<Scalar> rate{"rate"};
  Sum squares, particles;
  Minimum lowest;
  Maximum highest;

  std::shared_ptr<Stages> stages;
  Names names;

  void set(const std::string& field) {
    value.rename(names.keep(field));
    start.rename(names.keep(start_of(field)));
    start_rate.rename(names.keep(start_rate_of(field)));
    previous.rename(names.keep(previous_of(field)));
    rate.rename(names.keep(rate_of(field)));
  }

  void begin() {
    j_ = stages->current(step());
    last_ = j_ == stages->number;
    const Legendre legendre{stages->number};
    if (!stages->super) {  // Heun: the first stage is a step of Euler's method, the second the mean
      mu_ = 0.5, nu_ = 0.0, rate_part_ = j_ == 1 ? 1.0 : 0.5, start_rate_part_ = 0.0;
      time_ = 1.0;
      return;
    }
    mu_ = (2.0 * j_ - 1.0) / j_ * Legendre::b(j_) / Legendre::b(j_ - 1);
    nu_ = j_ < 2 ? 0.0 : -(j_ - 1.0) / j_ * Legendre::b(j_) / Legendre::b(j_ - 2);
    rate_part_ = j_ == 1 ? Legendre::b(1) * legendre.w1() : mu_ * legendre.w1();
    start_rate_part_ = -(1.0 - Legendre::b(j_ - 1)) * rate_part_;
    time_ = legendre.time(j_ - 1);
  }
  void end() {
    if (!last_ || !stages->super) return;
    stages->measured_step = stages->step;
    stages->squares += squares.result();
    stages->particles += particles.result();
    stages->lowest = std::min(stages->lowest, lowest.result());
    stages->highest = std::max(stages->highest, highest.result());
  }

  template <int D>
  void run_chunk(const shoal_chunk& chunk) const {
    if (j_ == 1)
      first(chunk.begin, chunk.end);
    else
      next(chunk.begin, chunk.end);
    if (!last_ || !stages->super) return;
    double sum = 0;
    const double dt = stages->step, of_rate = 0.5 / time_;
    for (std::uint64_t i = chunk.begin; i < chunk.end; ++i) {
      const double l0 = start_rate.data()[i], c = value.data()[i];
      const double e = c - start.data()[i] - dt * (l0 + of_rate * (rate.data()[i] - l0));
      sum += e * e;
      lowest.update(Particle<D>{i, chunk.partial}, std::min(c, start.data()[i]));
      highest.update(Particle<D>{i, chunk.partial}, std::max(c, start.data()[i]));
    }
    squares.update(Particle<D>{chunk.begin, chunk.partial}, sum);
    particles.update(Particle<D>{chunk.begin, chunk.partial}, static_cast<double>(chunk.end - chunk.begin));
  }

 private:
  void first(std::uint64_t begin, std::uint64_t end) const {
    double *c = value.data(), *c0 = start.data(), *l0 = start_rate.data(), *c1 = previous.data();
    const double* l = rate.data();
    const double dt = rate_part_ * stages->step;
    for (std::uint64_t i = begin; i < end; ++i) {
      c1[i] = c0[i] = c[i];
      l0[i] = l[i];
      c[i] += dt * l[i];
    }
  }
  void next(std::uint64_t begin, std::uint64_t end) const {
    double *c = value.data(), *c1 = previous.data();
    const double *l = rate.data(), *c0 = start.data(), *l0 = start_rate.data();
    const double dt = rate_part_ * stages->step, dt0 = start_rate_part_ * stages->step;
    const double mu = mu_, nu = nu_, of_start = 1.0 - mu_ - nu_;
    for (std::uint64_t i = begin; i < end; ++i) {
      const double moved = mu * c[i] + nu * c1[i] + of_start * c0[i] + dt * l[i] + dt0 * l0[i];
      c1[i] = c[i];
      c[i] = moved;
    }
  }

  int j_ = 1;
  bool last_ = false;
  double mu_ = 0, nu_ = 0, rate_part_ = 0, start_rate_part_ = 0, time_ = 1;
};

}  // namespace shoal::diffusion
