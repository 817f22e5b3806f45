// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Operators of diffusion.reaction. The split step is  R(dt/2) D(dt) R(dt/2)  (Strang 1968), of second order: one
// ReactionStep before the diffusion and one after it, each for half of the step.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "integrator.hpp"
#include "shoal/particle_operator.hpp"
#include "stimulus.hpp"

namespace shoal::diffusion {

// The model and what it is called with, for all operators of a body.
struct BodyReaction {
  ReactionIntegrator integrator;
  std::vector<std::unique_ptr<Stimulus>> stimuli;
  std::shared_ptr<const void> model;  // keeps it alive
};

// Fields of a model's variables as members of an operator.
template <class Member>
class VariableFields {
 public:
  void declare(const ReactionIntegrator& integrator) {
    for (std::size_t v = 0; v < integrator.n_variables(); ++v) {
      const shoal_reaction_variable& variable = integrator.variable(v);
      fields_.push_back(std::make_unique<Member>(variable.name, unit(variable.unit), doc(variable.doc)));
    }
  }
  std::vector<double*> at(std::uint64_t first) const {
    std::vector<double*> pointers;
    for (const auto& field : fields_) pointers.push_back(field->data() + first);
    return pointers;
  }

 private:
  std::vector<std::unique_ptr<Member>> fields_;
};

// Half a step of the reaction.
struct ReactionStep : ParticleOperator<ReactionStep> {
  In<Vector> position{"position"};
  VariableFields<InOut<Scalar>> variables;

  std::shared_ptr<const BodyReaction> reaction;
  bool second_half = false;
  double longest_step = 0;  // s, of the loop

  void set(std::shared_ptr<const BodyReaction> shared) {
    reaction = std::move(shared);
    variables.declare(reaction->integrator);
  }

  void block(std::uint64_t begin, std::uint64_t end) const {
    const double half = 0.5 * dt(), t = time() + (second_half ? half : 0.0);
    const double* x = position.data() + begin * static_cast<std::uint64_t>(dimensions());
    const std::uint64_t n = end - begin;
    std::vector<double> source;
    for (const auto& stimulus : reaction->stimuli) {
      if (!(stimulus->share(t, t + half) > 0.0)) continue;
      source.resize(n);
      stimulus->add(dimensions(), spacing(), n, x, t, t + half, source.data());
    }
    reaction->integrator.advance(dimensions(), t, half, n, x, variables.at(begin).data(),
                                 source.empty() ? nullptr : source.data());
  }
  double time_step(double) const { return longest_step; }
};

// Before the first step: a variable that is zero in the whole body, as it is where the case says nothing, gets the
// model's value at rest.
struct ReactionRest : ParticleOperator<ReactionRest> {
  VariableFields<InOut<Scalar>> variables;

  std::shared_ptr<const BodyReaction> reaction;

  void set(std::shared_ptr<const BodyReaction> shared) {
    reaction = std::move(shared);
    variables.declare(reaction->integrator);
  }
  // Serial: called once, with all particles.
  void block(std::uint64_t begin, std::uint64_t end) const {
    const std::vector<double*> y = variables.at(0);
    for (std::size_t v = 0; v < y.size(); ++v)
      if (std::all_of(y[v] + begin, y[v] + end, [](double value) { return value == 0.0; }))
        std::fill(y[v] + begin, y[v] + end, reaction->integrator.variable(v).initial);
  }
};

}  // namespace shoal::diffusion
