// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A reaction model in C++: parameters, variables, and their rates dy/dt = q - p y written once for double and Pack.
//
//     struct Decay final : shoal::ReactionModel<Decay, 1> {
//       Param<double> rate{"rate", "1/s", "Rate of decay.", positive};
//       std::vector<ReactionVariable> variables() const { return {{"concentration", "mol/m3", "Tracer.", 0.0, 0.0}}; }
//       double largest_step() const { return 0.1 / rate; }
//       template <Real R>
//       Rates<R, 1> rates(const std::array<R, 1>&) const { return {{R(0.0)}, {R(rate)}}; }
//     };
//     SHOAL_PLUGIN(example, "1.0.0") { add<Decay>("example.decay", "Exponential decay."); }
//
// A case uses it as `diffusion.reaction: {bodies: [water], model: {example.decay: {rate: 2}}}`.
#pragma once

#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "shoal/interfaces/reaction_model.h"
#include "shoal/material.hpp"
#include "shoal/pack.hpp"
#include "shoal/pack_math.hpp"

namespace shoal {

struct ReactionVariable {
  const char* name;
  const char* unit;
  const char* doc;
  double initial;
  double tolerance = 0;      // error that may be made in one step; 0: not looked at
  double excited = initial;  // of the first variable: what starts a wave
};

template <class R, std::size_t N>
struct Rates {
  std::array<R, N> q{}, p{};
};

inline namespace SHOAL_ISA_NAMESPACE {

// N variables, known when compiling.
template <class Derived, std::size_t N>
class ReactionModel : public Material {
 public:
  static constexpr std::size_t n_variables = N;

  const void* interface(std::string_view name, std::uint32_t revision) const override {
    return name == SHOAL_REACTION_MODEL && revision == SHOAL_REACTION_MODEL_REVISION ? &table_ : nullptr;
  }

 private:
  static const Derived& of(void* self) { return material_of<Derived>(self); }

  static std::uint32_t list_variables(void* self, const shoal_reaction_variable** variables) {
    std::vector<shoal_reaction_variable>& list =
        static_cast<ReactionModel&>(material_of<Derived>(self)).list_;
    if (list.empty())
      for (const ReactionVariable& v : of(self).variables())
        list.push_back(
            {sizeof(shoal_reaction_variable), 0, v.name, v.unit, v.doc, v.initial, v.tolerance, v.excited});
    *variables = list.data();
    return static_cast<std::uint32_t>(list.size());
  }

  static shoal_status block_rates(void* self, std::int32_t, double, std::uint64_t n, const double*,
                                  const double* const* y, double* const* q, double* const* p) {
    const Derived& model = of(self);
    for (std::uint64_t i = 0; i < n; i += static_cast<std::uint64_t>(lanes)) {
      std::array<Pack, N> state;
      for (std::size_t v = 0; v < N; ++v) state[v] = Pack::load(y[v] + i);
      const Rates<Pack, N> rates = model.rates(state);
      for (std::size_t v = 0; v < N; ++v) {
        rates.q[v].store(q[v] + i);
        rates.p[v].store(p[v] + i);
      }
    }
    return SHOAL_OK;
  }

  std::vector<shoal_reaction_variable> list_;
  inline static const shoal_reaction_model table_{sizeof(shoal_reaction_model), 0, &list_variables,
                                                  [](void* self) { return of(self).largest_step(); },
                                                  &block_rates};
};

}  // namespace SHOAL_ISA_NAMESPACE
}  // namespace shoal
