// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Fields: sizes, alignment, growth, permutation, and one meaning per name.
#include "kernel/particles/field.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "kernel/particles/body.hpp"
#include "kernel/particles/errors.hpp"

using namespace shoal::kernel;

namespace {

FieldSpecification real(const char* name, shoal_rank rank) { return {name, rank, SHOAL_DOUBLE, "1", ""}; }

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("components of ranks") {
  CHECK(components_of(SHOAL_SCALAR, 2) == 1);
  CHECK(components_of(SHOAL_RANK_VECTOR, 2) == 2);
  CHECK(components_of(SHOAL_SYMMETRIC, 2) == 3);
  CHECK(components_of(SHOAL_RANK_MATRIX, 2) == 4);
  CHECK(components_of(SHOAL_RANK_VECTOR, 3) == 3);
  CHECK(components_of(SHOAL_SYMMETRIC, 3) == 6);
  CHECK(components_of(SHOAL_RANK_MATRIX, 3) == 9);
}

TEST_CASE("arrays are aligned, padded and keep their values as they grow") {
  Field field(real("a", SHOAL_RANK_VECTOR), 3, "test");
  CHECK(field.resize(5, 0));
  for (int k = 0; k < 15; ++k) field.reals()[k] = k;
  std::uint64_t kept = 5;
  int moves = 0;
  for (const std::uint64_t n : {7u, 8u, 9u, 100u, 101u, 105u, 1000u}) {
    moves += field.resize(n, kept) ? 1 : 0;
    CHECK(reinterpret_cast<std::uintptr_t>(field.data()) % SHOAL_ALIGNMENT == 0);
    for (int k = 0; k < 15; ++k) CHECK(field.reals()[k] == k);
    const std::uint64_t padded = (n + SHOAL_PADDING - 1) / SHOAL_PADDING * SHOAL_PADDING;
    CHECK(field.bytes() >= padded * 24);
    for (std::uint64_t k = kept * 3; k < padded * 3; ++k) REQUIRE(field.reals()[k] == 0.0);
  }
  CHECK(moves < 7);  // growth by a quarter leaves room
}

TEST_CASE("a body's fields are re-sorted together, large and small, of every rank") {
  for (const std::uint64_t n : {7u, 20000u}) {
    Body body("water", 0, 3);
    body.resize(n);
    std::vector<Field*> fields = {&body.position(), &body.declare(real("s", SHOAL_SCALAR), "a"),
                                  &body.declare(real("y", SHOAL_SYMMETRIC), "a"),
                                  &body.declare(real("m", SHOAL_RANK_MATRIX), "a")};
    Field& integer = body.declare({"k", SHOAL_SCALAR, SHOAL_INT64, "1", ""}, "a");
    for (std::uint64_t i = 0; i < n; ++i) {
      for (Field* field : fields)
        for (std::uint32_t c = 0; c < field->components(); ++c)
          field->reals()[i * field->components() + c] = static_cast<double>(i) + 0.1 * c;
      integer.integers()[i] = 3 * static_cast<std::int64_t>(i);
    }
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    const void* before = body.position().data();
    body.permute(order.data());
    CHECK(body.position().data() == before);
    bool together = true;
    for (std::uint64_t k = 0; k < n; ++k) {
      const auto id = body.ids().integers()[k];
      together = together && id == order[k] && integer.integers()[k] == 3 * id;
      for (Field* field : fields)
        for (std::uint32_t c = 0; c < field->components(); ++c)
          together =
              together && field->reals()[k * field->components() + c] == static_cast<double>(id) + 0.1 * c;
    }
    CHECK(together);
  }
}

TEST_CASE("new particles get ids that were never used") {
  Body body("water", 0, 2);
  body.resize(3);
  body.resize(2);
  body.resize(4);
  CHECK(body.ids().integers()[1] == 1);
  CHECK(body.ids().integers()[2] == 3);
  CHECK(body.ids().integers()[3] == 4);
}

TEST_CASE("a clash of types names both declarers") {
  Body body("water", 0, 2);
  body.declare(specify("swelling", SHOAL_SCALAR, SHOAL_DOUBLE, "1", nullptr, "gel.swell"), "gel.swell");
  CHECK(message_of([&] {
          body.declare(specify("swelling", SHOAL_RANK_VECTOR, SHOAL_DOUBLE, "1", nullptr, "other.op"),
                       "other.op");
        }) ==
        "field 'swelling' is a real scalar in 1 for gel.swell, but a real vector in 1 for other.op; give one "
        "of them "
        "another name, or make them agree");
  CHECK(message_of([&] {
          body.declare(specify("swelling", SHOAL_SCALAR, SHOAL_INT64, "1", nullptr, "other.op"), "other.op");
        }).find("real scalar in 1 for gel.swell, but an integer scalar") != std::string::npos);
  CHECK(message_of([&] {
          body.declare(specify("swelling", SHOAL_SCALAR, SHOAL_DOUBLE, "m", nullptr, "other.op"), "other.op");
        }).find("in 1 for gel.swell, but a real scalar in m for other.op") != std::string::npos);
  // A reader that gives no unit agrees with everybody.
  CHECK_NOTHROW(
      body.declare(specify("swelling", SHOAL_SCALAR, SHOAL_DOUBLE, nullptr, nullptr, "third"), "third"));
  CHECK(body.find("swelling")->declarers() == std::vector<std::string>{"gel.swell", "third"});
}

TEST_CASE("shared fields have one meaning") {
  CHECK(specify("velocity", SHOAL_RANK_VECTOR, SHOAL_DOUBLE, nullptr, nullptr, "x").unit == "m/s");
  CHECK(message_of([] { specify("velocity", SHOAL_SCALAR, SHOAL_DOUBLE, nullptr, nullptr, "my.op"); }) ==
        "field 'velocity' is a real vector in m/s for all plugins (shoal/shared_fields.hpp), but a real "
        "scalar for "
        "my.op; give one of them another name, or make them agree");
  CHECK(message_of([] {
          specify("density", SHOAL_SCALAR, SHOAL_DOUBLE, "g", nullptr, "my.op");
        }).find("kg/m3") != std::string::npos);
  CHECK(message_of([] { specify("x", 17, SHOAL_DOUBLE, "1", nullptr, "my.op"); }) ==
        "my.op declares field 'x' with unknown rank 17");
}

TEST_CASE("arrays hold as many numbers as they are declared with") {
  Body body("tissue", 0, 2);
  const FieldSpecification gates =
      specify("gates", SHOAL_ARRAY, SHOAL_DOUBLE, "1", nullptr, "cell.gates", 19);
  body.declare(gates, "cell.gates");
  body.resize(3);
  CHECK(body.find("gates")->components() == 19);
  CHECK(body.find("gates")->bytes_per_particle() == 8 * 19);
  CHECK(message_of([&] {
          body.declare(specify("gates", SHOAL_ARRAY, SHOAL_DOUBLE, "1", nullptr, "other.op", 12), "other.op");
        }) ==
        "field 'gates' is a real array of 19 numbers in 1 for cell.gates, but a real array of 12 numbers in "
        "1 for "
        "other.op; give one of them another name, or make them agree");
  CHECK(message_of([] { specify("x", SHOAL_ARRAY, SHOAL_DOUBLE, "1", nullptr, "my.op"); }) ==
        "my.op declares field 'x' as an array of 0 numbers; an array has 1 to 4096");
  double* values = body.find("gates")->reals();
  for (std::size_t k = 0; k < 3 * 19; ++k) values[k] = static_cast<double>(k);
  const std::uint32_t order[] = {2, 0, 1};
  std::vector<double> scratch(3 * 19);
  body.find("gates")->permute(order, 3, scratch.data());
  for (std::size_t k = 0; k < 19; ++k) {
    CHECK(body.find("gates")->reals()[k] == static_cast<double>(2 * 19 + k));
    CHECK(body.find("gates")->reals()[19 + k] == static_cast<double>(k));
  }
}
