// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "reaction.hpp"

#include <cstdio>

#include "../cost.hpp"
#include "activation.hpp"
#include "model.hpp"
#include "reaction_step.hpp"

namespace shoal::diffusion {
namespace {

constexpr At at_before{"diffusion", "before"};
constexpr At at_after{"diffusion", "after"};
constexpr At at_initial{SHOAL_INITIAL, "state"};

std::unique_ptr<Stimulus> read_stimulus(const shoal_object& object, int dimensions) {
  if (std::string_view(object.type->name) != "diffusion.stimulus")
    throw CaseError(std::string(object.place) + ": " + object.type->name +
                    " is no stimulus; write {diffusion.stimulus: {...}}");
  auto stimulus = std::make_unique<Stimulus>();
  stimulus->read(object, dimensions);
  stimulus->validate();
  return stimulus;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

void Reaction::build(const Builder& b) {
  b.loop("diffusion", {"before", "diffuse", "after"});
  const auto work = OtherWork::of(b);
  const auto shared_model = std::make_shared<const Model>(*model->object, b.dimensions());
  for (const BodyIndex body : bodies.value()) {
    auto made = std::make_shared<BodyReaction>(
        BodyReaction{ReactionIntegrator(shared_model->interface(), adaptive), {}, shared_model});
    for (const ObjectHandle& object : stimuli.value())
      made->stimuli.push_back(read_stimulus(*object.object, b.dimensions()));
    const std::shared_ptr<const BodyReaction> reaction = std::move(made);
    const shoal_reaction_variable& first = reaction->integrator.variable(0);
    const double step = time_step.value_or(shared_model->largest_step());
    b.note(std::string(b.body(body).name) + ": " + model->object->type->name + ", " +
           std::to_string(reaction->integrator.n_variables()) + " variables, steps of at most " +
           number(step) + " s between reaction and diffusion");

    work->longest_step = std::min(work->longest_step, step);
    work->ns += static_cast<double>(b.body(body).n_particles * reaction->integrator.n_variables()) * 2.0 *
                measured::reaction_variable;

    b.attach<ReactionRest>(
        "diffusion.reaction_rest", at_initial, b.target(body), [&](auto& op) { op.set(reaction); },
        SHOAL_OPERATOR_SERIAL);
    b.attach<ReactionStep>("diffusion.reaction_before", at_before, b.target(body), [&](auto& op) {
      op.set(reaction);
      op.longest_step = step;
    });
    b.attach<ReactionStep>("diffusion.reaction_after", at_after, b.target(body), [&](auto& op) {
      op.set(reaction);
      op.longest_step = step;
      op.second_half = true;
    });
    const auto watch = [&](auto& op) { op.set(first); };
    b.attach<NotActivated>("diffusion.not_activated", at_initial, b.target(body), watch,
                           SHOAL_OPERATOR_ON_DEMAND);
    b.attach<ActivationTime>(
        "diffusion.activation_time", at_after, b.target(body),
        [&](auto& op) {
          watch(op);
          op.threshold = activation_threshold;
        },
        SHOAL_OPERATOR_ON_DEMAND);
  }
}

}  // namespace shoal::diffusion
