// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers of a particle by name: components, invariants, mirrors.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "kernel/output/field_part.hpp"
#include "kernel/particles/errors.hpp"

using namespace shoal::kernel;

namespace {

constexpr std::array<double, 3> plain{1.0, 1.0, 1.0};

double value(shoal_rank rank, int dimensions, const std::vector<double>& numbers, const std::string& name,
             const std::array<double, 3>& flip = plain) {
  const FieldInfo info{"f", "m", "", rank, SHOAL_DOUBLE, static_cast<std::uint32_t>(numbers.size())};
  // The second particle, so that strides matter.
  std::vector<double> data(numbers.size(), -99.0);
  data.insert(data.end(), numbers.begin(), numbers.end());
  const shoal_field field{sizeof(shoal_field), info.components, data.data(), 2, 2, nullptr};
  return FieldPart(info, name, dimensions, "case.yaml:1:2").value(field, 1, flip);
}

}  // namespace

TEST_CASE("components and invariants of vectors and matrices") {
  CHECK(value(SHOAL_SCALAR, 2, {7}, "f") == 7);
  CHECK(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f.y") == 4);
  CHECK(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f.magnitude") == 5);
  CHECK(value(SHOAL_RANK_VECTOR, 3, {2, 3, 6}, "f.magnitude") == 7);
  const std::vector<double> symmetric{1, 2, 3, 4, 5, 6};  // xx, xy, xz, yy, yz, zz
  CHECK(value(SHOAL_SYMMETRIC, 3, symmetric, "f.xz") == 3);
  CHECK(value(SHOAL_SYMMETRIC, 3, symmetric, "f.yz") == 5);
  CHECK(value(SHOAL_SYMMETRIC, 3, symmetric, "f.trace") == 11);
  CHECK(value(SHOAL_SYMMETRIC, 3, symmetric, "f.determinant") == doctest::Approx(-1.0));
  CHECK(value(SHOAL_SYMMETRIC, 3, symmetric, "f.magnitude") == doctest::Approx(std::sqrt(129.0)));
  CHECK(value(SHOAL_SYMMETRIC, 2, {1, 2, 3}, "f.yy") == 3);
  CHECK(value(SHOAL_SYMMETRIC, 2, {1, 2, 3}, "f.determinant") == -1);
  const std::vector<double> matrix{2, 0, 1, 1, 3, 0, 0, 1, 4};
  CHECK(value(SHOAL_RANK_MATRIX, 3, matrix, "f.yx") == 1);
  CHECK(value(SHOAL_RANK_MATRIX, 3, matrix, "f.xy") == 0);
  CHECK(value(SHOAL_RANK_MATRIX, 3, matrix, "f.determinant") == 25);
  CHECK(value(SHOAL_RANK_MATRIX, 2, {1, 2, 3, 4}, "f.determinant") == -2);
}

TEST_CASE("in a mirror, components change sign once for each axis that is turned") {
  const std::array<double, 3> x_turned{-1.0, 1.0, 1.0};
  CHECK(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f.x", x_turned) == -3);
  CHECK(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f.y", x_turned) == 4);
  CHECK(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f.magnitude", x_turned) == 5);
  CHECK(value(SHOAL_SYMMETRIC, 2, {1, 2, 3}, "f.xx", x_turned) == 1);
  CHECK(value(SHOAL_SYMMETRIC, 2, {1, 2, 3}, "f.xy", x_turned) == -2);
  CHECK(value(SHOAL_RANK_MATRIX, 2, {1, 2, 3, 4}, "f.yx", x_turned) == -3);
  CHECK(value(SHOAL_SCALAR, 2, {7}, "f", x_turned) == 7);
}

TEST_CASE("names that mean nothing say what there is") {
  CHECK_THROWS_WITH_AS(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f"),
                       "'f' is more than one number here; choose one of f.x, f.y, f.magnitude", ModelError);
  CHECK_THROWS_WITH_AS(value(SHOAL_RANK_VECTOR, 2, {3, 4}, "f.z"),
                       "the field 'f' has no part 'z' (x, y, magnitude)", ModelError);
  CHECK_THROWS_WITH_AS(value(SHOAL_SCALAR, 2, {3}, "f.x"), "the field 'f' is a number and has no 'x'",
                       ModelError);
  CHECK(field_of("velocity.x") == "velocity");
  CHECK(part_of("velocity") == "");
  CHECK(is_part_name("strain.xy"));
  CHECK_FALSE(is_part_name("2x"));
  CHECK_FALSE(is_part_name("a.b.c"));
}
