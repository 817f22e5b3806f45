// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Parameters: the tables that grow from members, and the values that a kernel hands over; what a plugin registers; and
// how its exceptions become statuses with a text.
#include <doctest/doctest.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "shoal/shoal.hpp"

using namespace shoal;

namespace {

struct All : Parameterised {
  Param<double> real{"real", "m", "Real.", positive, default_to(0.1), example("0.5")};
  Param<std::int64_t> integer{"integer", "1", "Integer.", between(2, 9), default_to(3)};
  Param<bool> boolean{"boolean", nullptr, "Boolean.", default_to(true)};
  Param<std::string> text{"text", nullptr, "Text."};
  Param<Choice> choice{"choice", nullptr, "Choice.", one_of("red", "green"), default_to("green")};
  Param<Vector3> vector{"vector", "m/s", "Vector.", optional};
  Param<FieldName> field{"field", nullptr, "Field.", optional};
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies."};
  Param<std::vector<Vector3>> vectors{"vectors", "m", "Vectors.", optional};
  Param<std::vector<double>> reals{"reals", "s", "Reals.", optional, below(7.0)};
  Param<ObjectHandle> object{"object", nullptr, "Object.", ObjectsOf{SHOAL_TYPE_MATERIAL}, optional};
};

shoal_value value_of(std::uint32_t kind, std::uint32_t n) {
  shoal_value value{};
  value.size = sizeof value;
  value.kind = kind;
  value.n = n;
  value.origin = SHOAL_ORIGIN_CASE;
  return value;
}

std::string failure;

shoal_host test_host() {
  shoal_host host{};
  host.size = sizeof host;
  host.abi_major = SHOAL_ABI_MAJOR;
  host.log = [](std::uint32_t, const char*) {};
  host.fail = [](const char* text) { failure = text; };
  return host;
}

}  // namespace

TEST_CASE("the table of parameters follows the members") {
  const All all;
  const auto table = all.parameter_table();
  REQUIRE(table.size() == 11);
  const std::array<std::uint32_t, 11> kinds{SHOAL_REAL,   SHOAL_INTEGER, SHOAL_BOOLEAN, SHOAL_TEXT,
                                            SHOAL_CHOICE, SHOAL_VECTOR,  SHOAL_FIELD,   SHOAL_BODY,
                                            SHOAL_VECTOR, SHOAL_REAL,    SHOAL_OBJECT};
  for (std::size_t k = 0; k < table.size(); ++k) {
    CAPTURE(table[k].key);
    CHECK(table[k].size == sizeof(shoal_parameter));
    CHECK(table[k].kind == kinds[k]);
    CHECK(((table[k].flags & SHOAL_PARAMETER_LIST) != 0) == (k >= 7 && k <= 9));
    const bool required = k == 3 || k == 7;  // no default, not optional
    CHECK(((table[k].flags & SHOAL_PARAMETER_REQUIRED) != 0) == required);
  }
  CHECK(std::string(table[0].key) == "real");
  CHECK(std::string(table[0].unit) == "m");
  CHECK(std::string(table[0].doc) == "Real.");
  CHECK(std::string(table[0].default_text) == "0.1");
  CHECK(std::string(table[0].example) == "0.5");
  CHECK(table[0].flags == (SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_MINIMUM_EXCLUDED));
  CHECK(table[0].minimum == 0.0);
  CHECK(table[1].flags == (SHOAL_PARAMETER_HAS_MINIMUM | SHOAL_PARAMETER_HAS_MAXIMUM));
  CHECK(table[1].minimum == 2.0);
  CHECK(table[1].maximum == 9.0);
  CHECK(std::string(table[1].default_text) == "3");
  CHECK(std::string(table[2].default_text) == "true");
  CHECK(table[3].default_text == nullptr);
  REQUIRE(table[4].n_choices == 2);
  CHECK(std::string(table[4].choices[1]) == "green");
  CHECK(table[9].flags ==
        (SHOAL_PARAMETER_LIST | SHOAL_PARAMETER_HAS_MAXIMUM | SHOAL_PARAMETER_MAXIMUM_EXCLUDED));
  CHECK(table[10].object_kind == SHOAL_TYPE_MATERIAL);
}

TEST_CASE("values of an object arrive in the members") {
  const double real = 2.5, vector[] = {1, 2}, vectors[] = {1, 2, 3, 4}, reals[] = {5, 6, 6.5};
  const std::int64_t integer = 7, no = 0, bodies[] = {4, 0};
  const char *text = "words", *choice = "red", *field = "velocity.x";
  const shoal_object inner{};
  const shoal_object* objects[] = {&inner};
  std::vector<shoal_value> values{
      value_of(SHOAL_REAL, 1),  value_of(SHOAL_INTEGER, 1), value_of(SHOAL_BOOLEAN, 1),
      value_of(SHOAL_TEXT, 1),  value_of(SHOAL_CHOICE, 1),  value_of(SHOAL_VECTOR, 1),
      value_of(SHOAL_FIELD, 1), value_of(SHOAL_BODY, 2),    value_of(SHOAL_VECTOR, 2),
      value_of(SHOAL_REAL, 3),  value_of(SHOAL_OBJECT, 1)};
  values[0].reals = &real;
  values[0].place = "case.yaml:3:7";
  values[1].integers = &integer;
  values[2].integers = &no;
  values[3].texts = &text;
  values[4].texts = &choice;
  values[5].reals = vector;
  values[6].texts = &field;
  values[7].integers = bodies;
  values[8].reals = vectors;
  values[9].reals = reals;
  values[10].objects = objects;
  shoal_object object{};
  object.size = sizeof object;
  object.n_values = static_cast<std::uint32_t>(values.size());
  object.values = values.data();
  All all;
  CHECK_FALSE(all.real.is_set());
  CHECK(all.real.value_or(8.0) == 8.0);
  all.read(object, 2);
  CHECK(all.real.is_set());
  CHECK(all.real == 2.5);
  CHECK(all.real.value_or(8.0) == 2.5);
  CHECK(all.real.place() == "case.yaml:3:7");
  CHECK(all.integer == 7);
  CHECK(all.boolean == false);
  CHECK(all.text.value() == "words");
  CHECK(all.choice.value() == "red");
  CHECK_FALSE(all.choice.value() == "green");
  CHECK(all.vector.value() == Vector3{1, 2, 0});
  CHECK(all.field->name == "velocity.x");
  REQUIRE(all.bodies->size() == 2);
  CHECK(all.bodies.value()[0].value == 4);
  CHECK(all.vectors.value() == std::vector<Vector3>{{1, 2, 0}, {3, 4, 0}});
  CHECK(all.reals.value() == std::vector<double>{5, 6, 6.5});
  CHECK(all.object->object == &inner);
}

TEST_CASE("values may be unset, fewer than the members, or begin later in the table") {
  const double real = 4.0;
  const std::int64_t integer = 5;
  std::vector<shoal_value> values{value_of(SHOAL_TEXT, 0), value_of(SHOAL_REAL, 1),
                                  value_of(SHOAL_INTEGER, 0)};
  values[1].reals = &real;
  values[2].place = "case.yaml:9:1";
  values[2].integers = &integer;
  shoal_object object{};
  object.n_values = 3;
  object.values = values.data();
  All all;
  all.integer = 6;
  all.read(object, 3, 1);
  CHECK(all.real == 4.0);
  CHECK_FALSE(all.integer.is_set());  // n is 0
  CHECK(all.integer == 6);
  CHECK(all.integer.place() == "case.yaml:9:1");
  CHECK_FALSE(all.text.is_set());  // an older kernel knew fewer
}

TEST_CASE("exceptions become a status, and a text that the host is told") {
  const shoal_host host = test_host();
  impl::host_table = &host;
  const auto run = [](auto&& callback) {
    failure.clear();
    return guarded(callback);
  };
  CHECK(run([] {}) == SHOAL_OK);
  CHECK(failure.empty());
  CHECK(run([] { throw CaseError("mend this"); }) == SHOAL_CASE_ERROR);
  CHECK(failure == "mend this");
  CHECK(run([] { throw PhysicsFailed("too fast"); }) == SHOAL_PHYSICS_FAILED);
  CHECK(failure == "too fast");
  CHECK(run([] { throw std::logic_error("a mistake"); }) == SHOAL_ERROR);
  CHECK(failure == "a mistake");
  CHECK(run([] { throw 3; }) == SHOAL_ERROR);
  CHECK(failure == "an exception of unknown type");
  // The host knows the text of its own failures already.
  CHECK(run([] { check_host(SHOAL_PHYSICS_FAILED); }) == SHOAL_PHYSICS_FAILED);
  CHECK(failure.empty());
  impl::host_table = nullptr;
}

namespace {

struct Drag : ParticleOperator<Drag> {
  Param<double> strength{"strength", "1/s", "Strength."};
  In<Vector> velocity{"velocity"};
  void particle(auto) const {}
};
struct Stuff : Physics {
  Param<bool> wet{"wet", nullptr, "Wet.", default_to(false)};
  void build(const Builder&) { throw CaseError("cannot be built"); }
};
struct Registered final : Plugin {
  Registered() : Plugin("sample", "1.2.3") {}
  void describe() override {
    summary("A sample.");
    citation("Nobody 1900");
    licence("MIT");
    requires_plugin("other", "1.0.0", "2.0.0");
    add<Drag>("sample.drag", "Slows down.", "Stokes 1851");
    add<Stuff>("sample.stuff", "Is stuff.");
  }
};

}  // namespace

TEST_CASE("a plugin's tables say what it registers") {
  const shoal_host host = test_host();
  Registered plugin;
  const shoal_plugin* c = impl::enter_plugin(&host, plugin);
  REQUIRE(c != nullptr);
  CHECK(c->size == sizeof(shoal_plugin));
  CHECK(std::string(c->id) == "sample");
  CHECK(std::string(c->version) == "1.2.3");
  CHECK(std::string(c->licence) == "MIT");
  CHECK(std::string(c->summary) == "A sample.");
  CHECK(std::string(c->citation) == "Nobody 1900");
  REQUIRE(c->n_requirements == 1);
  CHECK(std::string(c->requirements[0].id) == "other");
  CHECK(std::string(c->requirements[0].below_version) == "2.0.0");
  REQUIRE(c->n_types == 2);
  const shoal_type &drag = *c->types[0], &stuff = *c->types[1];
  CHECK(drag.kind == SHOAL_TYPE_OPERATOR);
  CHECK(std::string(drag.name) == "sample.drag");
  CHECK(std::string(drag.source) == "Stokes 1851");
  // What every operator has, then its own.
  REQUIRE(drag.n_parameters == 4);
  CHECK(std::string(drag.parameters[0].key) == "bodies");
  CHECK(std::string(drag.parameters[1].key) == "neighbours");
  CHECK(std::string(drag.parameters[2].key) == "at");
  CHECK(std::string(drag.parameters[3].key) == "strength");
  CHECK(stuff.kind == SHOAL_TYPE_PHYSICS);
  CHECK(stuff.source == nullptr);
  REQUIRE(stuff.n_parameters == 1);
  // An exception of build does not cross the boundary.
  shoal_object object{};
  object.type = &stuff;
  shoal_builder builder{};
  builder.dimensions = 2;
  CHECK(static_cast<const shoal_physics_api*>(stuff.api)->build(&object, &builder) == SHOAL_CASE_ERROR);
  CHECK(failure == "cannot be built");
  impl::host_table = nullptr;
}

TEST_CASE("a plugin that cannot describe itself is refused with its reason") {
  struct Broken final : Plugin {
    Broken() : Plugin("broken", "1.0.0") {}
    void describe() override { throw std::runtime_error("no licence server"); }
  } plugin;
  const shoal_host host = test_host();
  CHECK(impl::enter_plugin(&host, plugin) == nullptr);
  CHECK(failure == "no licence server");
  impl::host_table = nullptr;
}
