// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Tables of the kernel's own types, which have no prefix, and the checks that need no library.
#include <doctest/doctest.h>

#include "kernel/plugins/registry.hpp"

using namespace shoal::kernel;

namespace {

shoal_status create(const shoal_object*, int32_t, void**) { return SHOAL_OK; }
shoal_status distance(void*, uint64_t, const double*, double*) { return SHOAL_OK; }
void bounds(void*, double*, double*) {}
const shoal_shape_api shape_api{sizeof(shoal_shape_api), 0, create, nullptr, distance, bounds};

shoal_parameter parameter(shoal_value_kind kind, const char* key, const char* unit,
                          const char* text = nullptr) {
  shoal_parameter p{};
  p.size = sizeof(p);
  p.kind = kind;
  p.key = key;
  p.unit = unit;
  p.default_text = text;
  p.doc = "Of the test.";
  return p;
}

shoal_type shape(const char* name, const std::vector<shoal_parameter>& parameters = {}) {
  shoal_type type{};
  type.size = sizeof(type);
  type.kind = SHOAL_TYPE_SHAPE;
  type.name = name;
  type.doc = "Of the test.";
  type.n_parameters = static_cast<std::uint32_t>(parameters.size());
  type.parameters = parameters.data();
  type.api = &shape_api;
  return type;
}

std::vector<std::string> problems_of(const shoal_parameter& p, const ParameterCheck& deeper = {}) {
  const std::vector<shoal_parameter> table{p};
  const shoal_type type = shape("box", table);
  return check_type(type, "", deeper);
}

}  // namespace

TEST_CASE("the kernel's own types have plain names, and clash with nothing") {
  const shoal_type box = shape("box"), ball = shape("ball");
  const shoal_type* own[] = {&box, &ball};
  Registry registry;
  registry.add_own(own);
  CHECK(registry.names(SHOAL_TYPE_SHAPE) == std::vector<std::string>{"ball", "box"});
  CHECK(registry.find(SHOAL_TYPE_SHAPE, "box")->plugin.empty());

  LoadedPlugin plugin;
  plugin.id = "box";
  const shoal_type theirs = shape("box"), more = shape("box.rounded");
  plugin.types = {&more, &theirs};
  CHECK_THROWS_WITH_AS(registry.add(plugin),
                       doctest::Contains("box: this shape is already registered by Shoal itself"),
                       TableError);
  CHECK(registry.types().size() == 2);  // all or nothing

  plugin.id = "blob";
  const shoal_type same = shape("blob");  // the one type of a plugin may bear the plugin's name
  plugin.types = {&same};
  CHECK_NOTHROW(registry.add(plugin));
  CHECK(registry.find(SHOAL_TYPE_SHAPE, "blob")->plugin == "blob");
}

TEST_CASE("names, functions and docs of a type") {
  shoal_type type = shape("my.box");
  CHECK(check_type(type, "", {}) ==
        std::vector<std::string>{"my.box: a type of the kernel has a plain name in snake_case"});
  CHECK(check_type(type, "my", {}).empty());
  for (const char* name : {"my.", "my.Box", "my.a.b", ".box", "mybox", "other.box"}) {
    type.name = name;
    CHECK_MESSAGE(check_type(type, "my", {}).size() == 1, name);
  }
  type = shape("box");
  type.doc = " ";
  CHECK(check_type(type, "", {}) == std::vector<std::string>{"box: it has no doc"});
  type = shape("box");
  type.api = nullptr;
  CHECK(check_type(type, "", {}) == std::vector<std::string>{"box: it has no functions"});
  shoal_shape_api gap = shape_api;
  gap.distance = nullptr;
  type.api = &gap;
  CHECK(check_type(type, "", {}) == std::vector<std::string>{"box: its table of functions has a gap"});
  gap = shape_api;
  gap.size = 16;
  CHECK(check_type(type, "", {}) == std::vector<std::string>{"box: its table of functions is too short"});
  type = shape("box");
  type.n_parameters = 1;
  CHECK(check_type(type, "", {}) == std::vector<std::string>{"box: it counts parameters but lists none"});
  type.name = nullptr;
  CHECK(check_type(type, "", {}) == std::vector<std::string>{"a type has no name"});
}

TEST_CASE("defaults that are fine") {
  for (const char* text : {"1", "1e-6", "0.5 mm", "$dx", "2*H"})
    CHECK_MESSAGE(problems_of(parameter(SHOAL_REAL, "a", "m", text)).empty(), text);
  for (const char* text : {"1", "-7", "$n"})
    CHECK(problems_of(parameter(SHOAL_INTEGER, "a", nullptr, text)).empty());
  CHECK(problems_of(parameter(SHOAL_INTEGER, "a", "1", "3")).empty());
  CHECK(problems_of(parameter(SHOAL_VECTOR, "a", "m/s", "[0, 0]")).empty());
  CHECK(problems_of(parameter(SHOAL_TEXT, "a", nullptr, "")).empty());
  CHECK(problems_of(parameter(SHOAL_BOOLEAN, "a", nullptr, "true")).empty());
  shoal_parameter list = parameter(SHOAL_FIELD, "fields", nullptr, "[]");
  list.flags = SHOAL_PARAMETER_LIST;
  CHECK(problems_of(list).empty());
  shoal_parameter share = parameter(SHOAL_REAL, "a", "1", "1");
  share.flags = SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM;
  share.maximum = 1.0;
  CHECK(problems_of(share).empty());
  share.flags |= SHOAL_PARAMETER_MAXIMUM_EXCLUDED;
  CHECK(problems_of(share) ==
        std::vector<std::string>{"box, parameter 'a': the default 1 lies outside its bounds"});
}

TEST_CASE("defaults, units and bounds that are not") {
  const auto one = [](const std::string& text) {
    return std::vector<std::string>{"box, parameter 'a': " + text};
  };
  CHECK(problems_of(parameter(SHOAL_REAL, "a", "m", "1.2.3")) == one("the default '1.2.3' is no number"));
  CHECK(problems_of(parameter(SHOAL_REAL, "a", "m", "")) == one("its default is empty"));
  CHECK(problems_of(parameter(SHOAL_REAL, "a", " m")) == one("there are blanks around the unit ' m'"));
  CHECK(problems_of(parameter(SHOAL_VECTOR_EXPRESSION, "a", nullptr)) ==
        one("a number needs a unit; without dimension it is \"1\""));
  CHECK(problems_of(parameter(SHOAL_INTEGER, "a", "m")) == one("an integer has no unit"));
  shoal_parameter p = parameter(SHOAL_TEXT, "a", nullptr);
  p.flags = SHOAL_PARAMETER_HAS_MINIMUM;
  CHECK(problems_of(p) == one("a text has no bounds"));
  for (const auto& [kind, list] :
       {std::pair{SHOAL_VECTOR, 0u}, std::pair{SHOAL_REAL, 1u * SHOAL_PARAMETER_LIST}}) {
    p = parameter(kind, "a", "1");
    p.flags = SHOAL_PARAMETER_STEP_FACTOR | list;
    CHECK(problems_of(p) == one("only a single number can be a factor of time steps"));
  }
  p = parameter(SHOAL_REAL, "a", "m");
  p.flags = SHOAL_PARAMETER_MAXIMUM_EXCLUDED;
  CHECK(problems_of(p) == one("a bound is excluded that is not there"));
  p.flags = SHOAL_PARAMETER_HAS_MAXIMUM;
  p.maximum = 0.0 / p.minimum;
  CHECK(problems_of(p) == one("no number lies between its bounds"));
  p = parameter(SHOAL_REAL, "a", "m");
  p.flags = 1u << 30;
  CHECK(problems_of(p) == one("it has unknown flags"));
  p = parameter(SHOAL_REAL, "a", "m");
  p.object_kind = SHOAL_TYPE_SHAPE;
  CHECK(problems_of(p) == one("only an object has an object kind"));
}

TEST_CASE("whoever can parse units looks deeper, once the rest is well") {
  int calls = 0;
  const ParameterCheck deeper = [&](const shoal_parameter& p) {
    ++calls;
    return std::string(p.unit) == "parsecs per fortnight" ? "the unit is not known" : "";
  };
  CHECK(problems_of(parameter(SHOAL_REAL, "a", "parsecs per fortnight"), deeper) ==
        std::vector<std::string>{"box, parameter 'a': the unit is not known"});
  CHECK(problems_of(parameter(SHOAL_REAL, "a", "m"), deeper).empty());
  CHECK(problems_of(parameter(SHOAL_REAL, "a", nullptr), deeper).size() == 1);
  CHECK(calls == 2);
}
