// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The contract as a C++ compiler sees it: the same layout as in C, and the kernel's floor of what it accepts.
#include <doctest/doctest.h>

#include <cstring>
#include <map>
#include <string>

#include "kernel/plugins/abi_reading.hpp"
#include "shoal/abi.h"
#include "shoal/interfaces/equation_of_state.h"
#include "shoal/interfaces/stress_law.h"

#define SIZE(struct_, bytes_) static_assert(sizeof(struct_) == (bytes_));
#define MEMBER(struct_, member_, offset_, bytes_)         \
  static_assert(offsetof(struct_, member_) == (offset_)); \
  static_assert(sizeof(struct_::member_) == (bytes_));
#define VALUE(name_, value_) static_assert((name_) == (value_));
#include "interfaces.inc"
#include "layout.inc"
#undef SIZE
#undef MEMBER
#undef VALUE

extern "C" int layout_has_evaluate(const shoal_host* host);

using namespace shoal::kernel;

TEST_CASE("every struct that crosses the boundary begins with its size, but for the stamp") {
#define SIZE(struct_, bytes_)
#define MEMBER(struct_, member_, offset_, bytes_) \
  if (std::string(#member_) == "size") CHECK((offset_) == (std::string(#struct_) == "shoal_stamp" ? 8 : 0));
#define VALUE(name_, value_)
#include "interfaces.inc"
#include "layout.inc"
#undef SIZE
#undef MEMBER
#undef VALUE
}

TEST_CASE("members fill their structs without hidden gaps, so that every byte is initialised") {
  std::map<std::string, std::size_t> end;
#define SIZE(struct_, bytes_) end[#struct_] = 0;
#define MEMBER(struct_, member_, offset_, bytes_)                    \
  CHECK_MESSAGE(end[#struct_] == (offset_), #struct_ "::" #member_); \
  end[#struct_] = (offset_) + (bytes_);
#define VALUE(name_, value_)
#include "interfaces.inc"
#include "layout.inc"
#undef SIZE
#undef MEMBER
#undef VALUE
#define SIZE(struct_, bytes_) CHECK_MESSAGE(end[#struct_] == (bytes_), #struct_);
#define MEMBER(struct_, member_, offset_, bytes_)
#define VALUE(name_, value_)
#include "interfaces.inc"
#include "layout.inc"
}

TEST_CASE("the magic number reads as text in a hex dump") {
  const std::uint64_t magic = SHOAL_ABI_MAGIC;
  CHECK(std::memcmp(&magic, "HOAL ABI", 8) == 0);
}

TEST_CASE("SHOAL_HAS tells an older host from a newer one") {
  shoal_host host{};
  host.size = sizeof(shoal_host);
  CHECK(layout_has_evaluate(&host));
  CHECK(SHOAL_HAS(shoal_host, &host, evaluate));
  host.size = offsetof(shoal_host, evaluate);
  CHECK_FALSE(layout_has_evaluate(&host));
  CHECK_FALSE(SHOAL_HAS(shoal_host, &host, evaluate));
  CHECK(SHOAL_HAS(shoal_host, &host, fail));
}

TEST_CASE("elements of an array lie as far apart as their maker's struct is long") {
  struct Longer {
    shoal_requirement today;
    double more;
  };
  const Longer made[] = {{{sizeof(Longer), 0, "a", nullptr, nullptr}, 1.0},
                         {{sizeof(Longer), 0, "b", "1.0", nullptr}, 2.0},
                         {{sizeof(Longer), 0, "c", nullptr, "2.0"}, 3.0}};
  const shoal_requirement* array = &made[0].today;
  CHECK(std::string(abi_element(array, 1)->id) == "b");
  CHECK(std::string(abi_element(array, 2)->id) == "c");
  const shoal_requirement copy = abi_copy(abi_element(array, 2));
  CHECK(copy.size == sizeof(shoal_requirement));
  CHECK(std::string(copy.below_version) == "2.0");
}

TEST_CASE("a copy of a shorter struct has zeros where its maker knew nothing") {
  // As a plugin of an earlier version would hand it over, if the type had grown by its last two members since.
  shoal_type made{};
  made.size = offsetof(shoal_type, parameters);
  made.name = "early.type";
  made.parameters = reinterpret_cast<const shoal_parameter*>(&made);  // not part of what its maker knew
  made.api = &made;
  const shoal_type copy = abi_copy(&made);
  CHECK(std::string(copy.name) == "early.type");
  CHECK(copy.parameters == nullptr);
  CHECK(copy.api == nullptr);
  CHECK(copy.size == sizeof(shoal_type));
}

TEST_CASE("the smallest sizes that the kernel accepts are those of version 1.0") {
  static_assert(abi_smallest<shoal_stamp> == 112 && abi_smallest<shoal_plugin> == 72);
  static_assert(abi_smallest<shoal_requirement> == 32 && abi_smallest<shoal_type> == 56);
  static_assert(abi_smallest<shoal_parameter> == 88);
#define SMALLEST(struct_)           \
  CHECK(abi_smallest<struct_> > 0); \
  CHECK(abi_smallest<struct_> <= sizeof(struct_));
  SMALLEST(shoal_stamp)
  SMALLEST(shoal_plugin)
  SMALLEST(shoal_requirement)
  SMALLEST(shoal_type)
  SMALLEST(shoal_parameter)
  SMALLEST(shoal_physics_api)
  SMALLEST(shoal_material_api)
  SMALLEST(shoal_shape_api)
  SMALLEST(shoal_output_api)
  SMALLEST(shoal_probe_api)
}
