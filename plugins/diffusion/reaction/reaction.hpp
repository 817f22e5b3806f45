// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// diffusion.reaction: dy/dt = ... + q(y) - p(y) y for the variables of a reaction model, which are fields of the body;
// those that diffuse are named by diffusion.diffusion.
//
//   loop diffusion   before   half a step of the reaction
//                    diffuse  (diffusion.diffusion)
//                    after    half a step of the reaction, activation times
#pragma once

#include "shoal/physics.hpp"

namespace shoal::diffusion {

struct Reaction final : Physics {
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies in which the reaction runs.",
                                       example("[tissue]")};
  Param<ObjectHandle> model{"model", nullptr, "The reaction: a model of this plugin or of another one.",
                            ObjectsOf{SHOAL_TYPE_MATERIAL},
                            example("{diffusion.aliev_panfilov: {k: 8, a: 0.15}}")};
  Param<double> time_step{
      "time_step", "s",      "Longest step between reaction and diffusion; without it what the model needs.",
      positive,    optional, example("0.05 ms")};
  Param<bool> adaptive{"adaptive", nullptr,
                       "Whether particles in which the reaction is fast take smaller steps of their own.",
                       default_to(true)};
  Param<std::vector<ObjectHandle>> stimuli{"stimuli",
                                           nullptr,
                                           "Stimuli of the model's first variable.",
                                           ObjectsOf{SHOAL_TYPE_MATERIAL},
                                           optional,
                                           example("[{diffusion.stimulus: {rate: 35.7, duration: 2 ms}}]")};
  Param<double> activation_threshold{"activation_threshold", "1",
                                     "Value of the first variable, in its unit, whose first crossing sets "
                                     "the field activation_time (computed if "
                                     "an output or a probe asks for it).",
                                     default_to(0.0)};

  void build(const Builder& builder);
};

}  // namespace shoal::diffusion
