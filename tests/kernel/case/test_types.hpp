// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Types as plugins would register them, made by hand: one parameter of every kind.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kernel/case/schema.hpp"
#include "shoal/abi.h"

namespace shoal::kernel::test {

inline shoal_parameter parameter(std::uint32_t kind, const char* key, const char* unit, std::uint32_t flags,
                                 const char* default_text, const char* doc, const char* example) {
  shoal_parameter p{};
  p.size = sizeof(shoal_parameter);
  p.kind = kind;
  p.flags = flags;
  p.key = key;
  p.unit = unit;
  p.default_text = default_text;
  p.doc = doc;
  p.example = example;
  return p;
}

class TestTypes : public TypeCatalogue {
 public:
  TestTypes() {
    constexpr std::uint32_t required = SHOAL_PARAMETER_REQUIRED;
    constexpr std::uint32_t list = SHOAL_PARAMETER_LIST;
    constexpr std::uint32_t positive = SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_MINIMUM_EXCLUDED;
    constexpr std::uint32_t not_negative = SHOAL_PARAMETER_HAS_MINIMUM;
    static const char* const equations[] = {"tait", "linear", "stiffened"};

    const auto shape_parameter = [&](const char* key, std::uint32_t flags) {
      shoal_parameter p =
          parameter(SHOAL_OBJECT, key, nullptr, flags, nullptr, "A shape.", "{ball: {radius: 1}}");
      p.object_kind = SHOAL_TYPE_SHAPE;
      return p;
    };
    shoal_parameter equation = parameter(SHOAL_CHOICE, "equation_of_state", nullptr, 0, "tait",
                                         "How pressure follows from density.", "linear");
    equation.choices = equations;
    equation.n_choices = 3;
    shoal_parameter iterations = parameter(SHOAL_INTEGER, "iterations", nullptr,
                                           SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM, "1",
                                           "Number of iterations.", "2");
    iterations.minimum = 1;
    iterations.maximum = 10;
    shoal_parameter porosity = parameter(
        SHOAL_REAL, "porosity", "1",
        SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM | SHOAL_PARAMETER_MAXIMUM_EXCLUDED, nullptr,
        "Share of the volume that is empty.", "30 %");
    porosity.maximum = 1;

    add(SHOAL_TYPE_SHAPE, "ball", "A ball, a disc in two dimensions.",
        {parameter(SHOAL_REAL, "radius", "m", required | positive, nullptr, "Radius.", "0.5 m"),
         parameter(SHOAL_VECTOR, "centre", "m", 0, "[0, 0, 0]", "Centre.", "[0, 1]")});
    add(SHOAL_TYPE_SHAPE, "box", "A box along the axes.",
        {parameter(SHOAL_VECTOR, "lower", "m", required, nullptr, "Lower corner.", "[0, 0]"),
         parameter(SHOAL_VECTOR, "upper", "m", required, nullptr, "Upper corner.", "[2, 1]")});
    add(SHOAL_TYPE_SHAPE, "shell", "The layer around a shape.",
        {shape_parameter("of", required),
         parameter(SHOAL_REAL, "thickness", "m", required | positive, nullptr, "Thickness.", "4*dx")});
    add(SHOAL_TYPE_SHAPE, "union", "What any of the shapes holds.", {shape_parameter("of", required | list)});
    add(SHOAL_TYPE_SHAPE, "polygon", "A polygon.",
        {parameter(SHOAL_VECTOR, "vertices", "m", required | list, nullptr, "Its corners.",
                   "[[0, 0], [1, 0], [0, 1]]")});
    add(SHOAL_TYPE_MATERIAL, "fluid.liquid", "A liquid that is hardly compressible.",
        {parameter(SHOAL_REAL, "density", "kg/m3", required | positive, nullptr, "Density at rest.", "1000"),
         parameter(SHOAL_REAL, "viscosity", "m2/s", not_negative, "0", "Kinematic viscosity.", "1e-6"),
         parameter(SHOAL_REAL, "sound_speed", "m/s", positive, nullptr,
                   "Speed of sound; ten times the fastest flow.", "20"),
         equation, parameter(SHOAL_REAL, "temperature", "K", positive, "20 degC", "Temperature.", "293"),
         parameter(SHOAL_BOOLEAN, "free_surface", nullptr, 0, "true", "Whether it has a free surface.",
                   "false"),
         iterations, porosity,
         parameter(SHOAL_MATRIX, "permeability", "m2", 0, nullptr, "Permeability.", "[[1, 0], [0, 1]]"),
         parameter(SHOAL_FILE, "table", nullptr, 0, nullptr, "Table of the equation of state.", "water.csv"),
         parameter(SHOAL_TEXT, "label", nullptr, 0, nullptr, "A text.", "water"),
         parameter(SHOAL_REAL, "pressure_limit", "Pa", 0, "inf", "Largest pressure.", "1 MPa")});
    add(SHOAL_TYPE_MATERIAL, "fluid.wall", "A wall.", {});
    shoal_parameter passive = parameter(SHOAL_OBJECT, "passive", nullptr, required, nullptr, "What it wraps.",
                                        "{fluid.liquid: {density: 1000}}");
    passive.object_kind = SHOAL_TYPE_MATERIAL;
    add(SHOAL_TYPE_MATERIAL, "fluid.active", "A material in another.", {passive});
    add(SHOAL_TYPE_PHYSICS, "fluid.wcsph", "A weakly compressible flow.",
        {parameter(SHOAL_BODY, "bodies", nullptr, required | list, nullptr, "Bodies that flow.", "[water]"),
         parameter(SHOAL_BODY, "walls", nullptr, list, "[]", "Bodies that are walls.", "[tank]"),
         parameter(SHOAL_VECTOR_EXPRESSION, "inflow", "m/s", 0, nullptr, "Velocity at the inlet.",
                   "[\"1 - y^2\", 0]"),
         parameter(SHOAL_EXPRESSION, "heating", "W/m3", 0, "0", "Heat that is added.", "\"sin(t)\""),
         parameter(SHOAL_REAL, "times", "s", list, "[]", "Times.", "[0.1, 0.2]")});
    add(SHOAL_TYPE_OUTPUT, "vtk", "Pictures.",
        {parameter(SHOAL_REAL, "every", "s", positive, nullptr, "Time between pictures.", "50 ms"),
         parameter(SHOAL_FIELD, "fields", nullptr, list, "[]", "Fields beside the positions.",
                   "[velocity]")});
    add(SHOAL_TYPE_PROBE, "maximum", "The largest value of a field.",
        {parameter(SHOAL_FIELD, "of", nullptr, required, nullptr, "The field.", "position.x"),
         parameter(SHOAL_BODY, "body", nullptr, required, nullptr, "The body.", "water")});
    add(SHOAL_TYPE_PROBE, "energy", "Kinetic energy of all bodies.", {});
  }

  TypeEntry find(shoal_type_kind kind, const std::string& name) const override {
    const auto found = types_.find(name);
    if (found == types_.end() || found->second.type.kind != static_cast<std::uint32_t>(kind)) return {};
    return {&found->second.type, &found->second.type};
  }
  std::vector<std::string> names(shoal_type_kind kind) const override {
    std::vector<std::string> result;
    for (const auto& [name, entry] : types_) {
      if (entry.type.kind == static_cast<std::uint32_t>(kind)) result.push_back(name);
    }
    return result;
  }
  std::string explain_unknown(shoal_type_kind, const std::string& name) const override {
    return name.rfind("solid.", 0) == 0 ? "it is in the plugin 'solid'; add 'solid' to 'plugins'" : "";
  }
  bool is_excused(const std::string& name) const override { return name.rfind("absent.", 0) == 0; }

  const shoal_type& type(const std::string& name) const { return types_.at(name).type; }
  std::vector<const shoal_type*> all() const {
    std::vector<const shoal_type*> result;
    for (const auto& [name, entry] : types_) result.push_back(&entry.type);
    return result;
  }

 private:
  struct Entry {
    std::vector<shoal_parameter> parameters;
    shoal_type type{};
  };
  void add(shoal_type_kind kind, const char* name, const char* doc, std::vector<shoal_parameter> parameters) {
    Entry& entry = types_[name];
    entry.parameters = std::move(parameters);
    entry.type.size = sizeof(shoal_type);
    entry.type.kind = static_cast<std::uint32_t>(kind);
    entry.type.name = name;
    entry.type.doc = doc;
    entry.type.parameters = entry.parameters.data();
    entry.type.n_parameters = static_cast<std::uint32_t>(entry.parameters.size());
  }
  std::map<std::string, Entry> types_;
};

}  // namespace shoal::kernel::test
