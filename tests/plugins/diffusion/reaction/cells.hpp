// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Particles with the variables of a reaction model, and the derivative of the model in plain numbers.
#pragma once

#include <cstdlib>
#include <deque>
#include <vector>

#include "integrator.hpp"
#include "shoal/reaction_model.hpp"

namespace shoal::diffusion::test {

// An object of a case that names a model and nothing else: all parameters have their defaults.
template <class Model>
class DefaultObject {
 public:
  explicit DefaultObject(const char* name) {
    type_.size = sizeof type_;
    type_.kind = SHOAL_TYPE_MATERIAL;
    type_.name = name;
    type_.api = Model::template api<Model>();
    for (const shoal_parameter& parameter : table_) {
      shoal_value value{};
      value.size = sizeof value;
      value.kind = parameter.kind;
      value.n = parameter.default_text ? 1 : 0;
      if (value.n == 1 && parameter.kind == SHOAL_REAL)
        value.reals = &numbers_.emplace_back(std::strtod(parameter.default_text, nullptr));
      if (value.n == 1) value.texts = &texts_.emplace_back(parameter.default_text);
      values_.push_back(value);
    }
    object_.size = sizeof object_;
    object_.n_values = static_cast<std::uint32_t>(values_.size());
    object_.values = values_.data();
    object_.type = &type_;
    object_.place = "case.yaml:1:1";
  }
  const shoal_object& object() const { return object_; }

 private:
  Model prototype_;
  std::vector<shoal_parameter> table_ = prototype_.parameter_table();
  std::vector<shoal_value> values_;
  std::deque<double> numbers_;
  std::deque<const char*> texts_;
  shoal_type type_{};
  shoal_object object_{};
};

template <class Model>
struct WithDefaults {
  Model model;

  WithDefaults() { model.read(DefaultObject<Model>("test.model").object(), 2); }
  operator const Model&() const { return model; }
};

template <class Model>
Interface<shoal_reaction_model> interface_of(const Model& model) {
  Interface<shoal_reaction_model> found;
  found.api = static_cast<const shoal_reaction_model*>(
      model.interface(SHOAL_REACTION_MODEL, SHOAL_REACTION_MODEL_REVISION));
  found.self = const_cast<Material*>(static_cast<const Material*>(&model));
  return found;
}

// n particles at the model's rest.
class Cells {
 public:
  Cells(const ReactionIntegrator& integrator, std::size_t n)
      : integrator_(integrator), n_(n), y_(integrator.n_variables()), position_(2 * n) {
    for (std::size_t v = 0; v < y_.size(); ++v)
      y_[v].assign((n + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING, integrator.variable(v).initial);
  }

  std::vector<double>& operator[](std::size_t v) { return y_[v]; }
  void advance(double t, double dt, const double* source = nullptr) {
    std::vector<double*> y;
    for (auto& values : y_) y.push_back(values.data());
    integrator_.advance(2, t, dt, n_, position_.data(), y.data(), source);
  }

 private:
  const ReactionIntegrator& integrator_;
  std::size_t n_;
  std::vector<std::vector<double>> y_;
  std::vector<double> position_;
};

// The classical Runge-Kutta method for one particle, with a model's rates as plain numbers: slow, obvious, and accurate
// where the steps are small.
template <class Model, std::size_t N>
std::array<double, N> runge_kutta(const Model& model, std::array<double, N> y, double time, int steps) {
  const double dt = time / steps;
  const auto f = [&](const std::array<double, N>& state) {
    const Rates<double, N> rates = model.rates(state);
    std::array<double, N> rate;
    for (std::size_t v = 0; v < N; ++v) rate[v] = rates.q[v] - rates.p[v] * state[v];
    return rate;
  };
  const auto ahead = [&](const std::array<double, N>& rate, double step) {
    std::array<double, N> state = y;
    for (std::size_t v = 0; v < N; ++v) state[v] += step * rate[v];
    return state;
  };
  for (int k = 0; k < steps; ++k) {
    const auto a = f(y), b = f(ahead(a, dt / 2)), c = f(ahead(b, dt / 2)), d = f(ahead(c, dt));
    for (std::size_t v = 0; v < N; ++v) y[v] += dt / 6 * (a[v] + 2 * b[v] + 2 * c[v] + d[v]);
  }
  return y;
}

}  // namespace shoal::diffusion::test
