// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// diffusion.formula: a reaction written in the case, dy/dt = rate - decay y for each of the named variables, rates and
// decays being expressions of the variables, of place and time, and of the case's parameters, e.g. the Brusselator
//     model: {diffusion.formula: {variables: [u, v], rates: ["a + u^2*v", "b*u - u^2*v"], decays: [b + 1, 0]}}
// Expressions are evaluated one particle after the other: a model that matters for time is better written in C++
// (shoal/reaction_model.hpp).
#pragma once

#include <algorithm>
#include <deque>
#include <string>
#include <vector>

#include "shoal/interfaces/reaction_model.h"
#include "shoal/material.hpp"

namespace shoal::diffusion {

class Formula final : public Material {
 public:
  const void* interface(std::string_view name, std::uint32_t revision) const override {
    return name == SHOAL_REACTION_MODEL && revision == SHOAL_REACTION_MODEL_REVISION ? &table_ : nullptr;
  }
  // Checks what the table of parameters cannot. Throws CaseError.
  void prepare();

 private:
  // An expression with the variables that it uses, in the order of its names.
  struct Term {
    Expression expression;
    std::vector<std::size_t> variables;
  };
  Term term(const Expression& expression, const std::string& place) const;
  void fill(const std::vector<Term>& terms, int dimensions, double t, std::uint64_t n, const double* position,
            const double* const* y, double* const* out) const;

  Param<std::vector<FieldName>> variables_{"variables", nullptr, "Fields that react.", example("[u, v]")};
  Param<std::vector<Expression>> rates_{
      "rates", "1", "For each variable what it gains in a second, in SI units; may use the variables' names.",
      own_names, example("[\"a + u^2*v\", \"b*u - u^2*v\"]")};
  Param<std::vector<Expression>> decays_{"decays",
                                         "1",
                                         "For each variable the part of it that it loses in a second, not "
                                         "negative. Where a reaction is fast, what is written "
                                         "here instead of under rates stays stable with long steps.",
                                         own_names,
                                         optional,
                                         example("[b + 1, 0]")};
  Param<double> step_{"step", "s", "Longest step between reaction and diffusion.", positive, example("0.01")};
  Param<double> tolerance_{"tolerance", "1",
                           "Error that a step may make in a variable; particles cut their steps to keep it.",
                           positive, default_to(1e-3)};

  std::vector<Term> gains_, losses_;
  std::vector<shoal_reaction_variable> list_;

  static const shoal_reaction_model table_;
};

inline Formula::Term Formula::term(const Expression& expression, const std::string& place) const {
  Term term{expression, {}};
  for (const std::string& name : expression.names()) {
    const auto& known = variables_.value();
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const FieldName& one) { return one.name == name; });
    if (found == known.end()) {
      std::string all;
      for (const FieldName& one : known) all += (all.empty() ? "" : ", ") + one.name;
      throw CaseError(place + ": unknown name '" + name + "'; variables of the formula: " + all);
    }
    term.variables.push_back(static_cast<std::size_t>(found - known.begin()));
  }
  return term;
}

inline void Formula::prepare() {
  const std::size_t n = variables_->size();
  if (rates_->size() != n)
    throw CaseError(rates_.place() + ": there are " + std::to_string(n) + " variables, but " +
                    std::to_string(rates_->size()) + " rates; give one for each");
  if (decays_.is_set() && decays_->size() != n)
    throw CaseError(decays_.place() + ": there are " + std::to_string(n) + " variables, but " +
                    std::to_string(decays_->size()) + " decays; give one for each, 0 where there is none");
  gains_.clear();
  losses_.clear();
  for (const Expression& rate : rates_.value()) gains_.push_back(term(rate, rates_.place()));
  if (decays_.is_set())
    for (const Expression& decay : decays_.value()) losses_.push_back(term(decay, decays_.place()));
  for (const FieldName& variable : variables_.value())
    list_.push_back({sizeof(shoal_reaction_variable), 0, variable.name.c_str(), nullptr,
                     "Variable of a formula of the case.", 0.0, tolerance_, 0.0});
}

inline void Formula::fill(const std::vector<Term>& terms, int dimensions, double t, std::uint64_t n,
                          const double* position, const double* const* y, double* const* out) const {
  std::vector<const double*> columns;
  for (std::size_t v = 0; v < terms.size(); ++v) {
    columns.clear();
    for (const std::size_t used : terms[v].variables) columns.push_back(y[used]);
    terms[v].expression.evaluate(dimensions, n, position, columns.data(), t, out[v]);
  }
}

inline const shoal_reaction_model Formula::table_{
    sizeof(shoal_reaction_model), 0,
    [](void* self, const shoal_reaction_variable** variables) {
      Formula& formula = material_of<Formula>(self);
      if (formula.list_.empty() && guarded([&] { formula.prepare(); }) != SHOAL_OK) formula.list_.clear();
      *variables = formula.list_.data();
      return static_cast<std::uint32_t>(formula.list_.size());
    },
    [](void* self) { return material_of<Formula>(self).step_.value(); },
    [](void* self, std::int32_t dimensions, double t, std::uint64_t n, const double* position,
       const double* const* y, double* const* q, double* const* p) {
      return guarded([&] {
        const Formula& formula = material_of<Formula>(self);
        formula.fill(formula.gains_, dimensions, t, n, position, y, q);
        if (formula.losses_.empty())
          for (std::size_t v = 0; v < formula.list_.size(); ++v) std::fill_n(p[v], n, 0.0);
        else
          formula.fill(formula.losses_, dimensions, t, n, position, y, p);
      });
    }};

}  // namespace shoal::diffusion
