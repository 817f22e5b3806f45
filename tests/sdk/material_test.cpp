// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Materials that wrap other materials, and operators whose fields a material declares.
#include <doctest/doctest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "shoal/shoal.hpp"
#include "shoal/testing.hpp"

using namespace shoal;

namespace {

std::string failure;

void listen_to_failures() {
  static const shoal_host host = [] {
    shoal_host table{};
    table.size = sizeof table;
    table.log = [](std::uint32_t, const char*) {};
    table.fail = [](const char* text) { failure = text; };
    return table;
  }();
  shoal::impl::host_table = &host;
}

struct Spring final : Material {
  Param<double> stiffness{"stiffness", "N/m", "Stiffness.", default_to(1.0)};
  static inline int alive = 0;
  Spring() { ++alive; }
  ~Spring() override { --alive; }
  const void* interface(std::string_view name, std::uint32_t revision) const override {
    return name == "stiffness" && revision == 2 ? &stiffness.value() : nullptr;
  }
};

struct Broken final : Material {
  Broken() { throw CaseError("a spring cannot be broken"); }
};

template <class M>
shoal_type type_of(const char* name) {
  shoal_type type{};
  type.size = sizeof type;
  type.kind = SHOAL_TYPE_MATERIAL;
  type.name = name;
  type.api = M::template api<M>();
  return type;
}

// A law's own fields: one of each rank that a law may use.
const std::array<shoal_access, 3> accesses{{
    {sizeof(shoal_access), SHOAL_READ, SHOAL_SCALAR, SHOAL_DOUBLE, "heat", "K", "Heat.", 0, 0},
    {sizeof(shoal_access), SHOAL_READ | SHOAL_WRITE, SHOAL_SYMMETRIC, SHOAL_DOUBLE, "metric", "1", "Metric.",
     0, 0},
    {sizeof(shoal_access), SHOAL_READ, SHOAL_RANK_VECTOR, SHOAL_DOUBLE, "fibre", nullptr, nullptr, 0, 0},
}};

struct Caller : ParticleOperator<Caller> {
  DeclaredFields law{*this};
  Out<Scalar> sum{"sum", unit("1"), doc("Sum.")};

  void block(std::uint64_t begin, std::uint64_t end) const {
    std::array<double*, DeclaredFields::most> fields{};
    law.at(begin, fields.data());
    const std::uint64_t d = dimensions() == 2 ? 2 : 3, s = d * (d + 1) / 2;
    for (std::uint64_t k = 0; k < end - begin; ++k) {
      fields[1][k * s + s - 1] += 1.0;
      sum.data()[begin + k] = fields[0][k] + fields[1][k * s + s - 1] + fields[2][k * d + 1];
    }
  }
};

}  // namespace

TEST_CASE("a material is made from a parameter, and lives as long as its owner") {
  listen_to_failures();
  const shoal_type type = type_of<Spring>("test.spring");
  shoal_value value{};
  value.size = sizeof value;
  const double stiffness = 7.0;
  value.kind = SHOAL_REAL;
  value.n = 1;
  value.reals = &stiffness;
  const shoal_object object{sizeof(shoal_object), 1, &type, &value, "case.yaml:1:1"};
  {
    OwnedMaterial spring(ObjectHandle{&object}, 3);
    CHECK(Spring::alive == 1);
    OwnedMaterial moved;
    CHECK_FALSE(moved);
    moved = std::move(spring);
    REQUIRE(moved);
    CHECK(*moved.interface<double>("stiffness", 2) == 7.0);
    CHECK(moved.interface<double>("stiffness", 1) == nullptr);
    CHECK(material_of<Spring>(moved.self()).dimensions() == 3);
    CHECK(Spring::alive == 1);
  }
  CHECK(Spring::alive == 0);
}

TEST_CASE("a wrapped material that cannot be made says why") {
  listen_to_failures();
  const shoal_type type = type_of<Broken>("test.broken");
  const shoal_object object{sizeof(shoal_object), 0, &type, nullptr, "case.yaml:1:1"};
  const shoal_status status = guarded([&] { OwnedMaterial broken(ObjectHandle{&object}, 2); });
  CHECK(status == SHOAL_CASE_ERROR);
  CHECK(failure == "a spring cannot be broken");
}

TEST_CASE("an operator has the fields that a material declares, at the particles of its blocks") {
  for (const int dimensions : {2, 3}) {
    Caller op;
    op.law.declare(3, accesses.data());
    CHECK(op.law.size() == 3);
    const auto list = op.accesses();
    REQUIRE(list.size() == 4);
    CHECK(std::string(list[2].field) == "metric");
    CHECK(list[2].mode == (SHOAL_READ | SHOAL_WRITE));

    const auto d = static_cast<std::size_t>(dimensions);
    testing::Body body(dimensions, std::vector<double>(5 * d, 0.0));
    body.set_each("heat", 1, [](std::size_t i, std::size_t) { return 100.0 * double(i); });
    body.set_each("metric", d * (d + 1) / 2, [](std::size_t i, std::size_t) { return 10.0 * double(i); });
    body.set_each("fibre", d, [](std::size_t i, std::size_t c) { return c == 1 ? double(i) : -1.0; });
    testing::run(op, body, {}, {});
    for (std::size_t i = 0; i < 5; ++i) CHECK(body["sum"][i] == 111.0 * double(i) + 1.0);
  }
}

TEST_CASE("whoever only looks does not write the state of a material") {
  Caller op;
  op.law.declare(3, accesses.data(), false);
  for (const shoal_access& access : op.accesses())
    if (std::string(access.field) != "sum") CHECK(access.mode == SHOAL_READ);
}

TEST_CASE("there is a most of the fields that a material may have") {
  Caller op;
  const std::vector<shoal_access> many(DeclaredFields::most + 1, accesses[0]);
  CHECK_THROWS_WITH_AS(op.law.declare(DeclaredFields::most + 1, many.data()),
                       "a material with more than 16 fields", CaseError);
}
