// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// How the kernel's own probes are made; probe.hpp is what others need.
#pragma once

#include <memory>

#include "kernel/output/probes/probe.hpp"
#include "shoal/parameters.hpp"

namespace shoal::kernel {

enum class Reduce { maximum, minimum, sum, mean };

struct ReductionParameters : Parameterised {
  Param<std::vector<std::string>> of{
      "of", nullptr,
      "What: an expression of fields of a particle and their parts (velocity.x, "
      "velocity.magnitude), of its place x, y, z, of t and of the case's parameters. "
      "Several give as many columns.",
      example("0.5 * mass * velocity.magnitude^2")};
  Param<std::vector<BodyIndex>> body{"body", nullptr, "Body or bodies whose particles count.",
                                     example("water")};
  Param<std::string> where{"where", nullptr, "Only particles for which this condition holds count.", optional,
                           example("position.y > 0.1")};
  Param<bool> root{
      "root", nullptr,
      "Whether the square root of the result is taken: of the mean of squares it is the root mean square.",
      default_to(false)};
  Param<std::string> unit{"unit", nullptr, "Unit of the result, for the head of the table.", optional,
                          example("J")};
};

struct PointParameters : Parameterised {
  Param<std::vector<std::string>> of{
      "of", nullptr,
      "What: a field or its part, or an expression as for maximum. Several give as many "
      "columns.",
      example("velocity.magnitude")};
  Param<std::vector<BodyIndex>> body{"body", nullptr, "Body or bodies whose particles are interpolated.",
                                     example("water")};
  Param<VectorExpression> at{"at", "m", "The point; it moves if its coordinates are expressions of t.",
                             example("[5.366, 0.2]")};
  Param<double> support{
      "support",
      "1",
      "Share of the smoothing kernel that particles must fill for there to be a value; with less it "
      "is NaN. 1 inside a body, 0.5 at a flat surface.",
      between(0, 1),
      default_to(0.05),
      example("0.25")};
  Param<bool> linear{"linear", nullptr,
                     "Whether linear fields are interpolated exactly, also towards a wall, a surface or a "
                     "corner beyond the last particles.",
                     default_to(false)};
  Param<double> diameter{"diameter",
                         "m",
                         "With it the mean over a disc of this size about the point, as a gauge in a wall "
                         "measures it; in 2D the disc's chords are weighed.",
                         positive,
                         optional,
                         example("90 mm")};
  Param<Vector3> normal{"normal", "1", "Axis of the disc.", optional, example("[1, 0]")};
  Param<double> empty{"empty", "1",
                      "Value where there are too few particles, e.g. 0 for the load on the dry part of a "
                      "gauge; without it NaN, and of a disc only the rest counts.",
                      optional, example("0")};
  Param<std::string> unit{"unit", nullptr, "Unit of the result, for the head of the table.", optional,
                          example("m/s")};
};

std::unique_ptr<Probe> make_reduction(Reduce how, const shoal_object& object, const ProbeContext& context);
std::unique_ptr<Probe> make_point(const shoal_object& object, const ProbeContext& context);
std::unique_ptr<Probe> make_plugin_probe(const shoal_object& object, const ProbeContext& context);

}  // namespace shoal::kernel
