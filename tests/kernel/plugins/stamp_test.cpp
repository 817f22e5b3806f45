// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What makes a stamp acceptable, versions, and instruction sets; all without a library.
#include <doctest/doctest.h>

#include "kernel/plugins/isa.hpp"
#include "kernel/plugins/plugin_file.hpp"

using namespace shoal::kernel;

namespace {

shoal_stamp sound_stamp() {
  shoal_stamp stamp{};
  stamp.magic = SHOAL_ABI_MAGIC;
  stamp.size = sizeof(shoal_stamp);
  stamp.abi_major = 4;
  stamp.abi_minor = 2;
  stamp.real_bytes = 8;
  stamp.index_bytes = 4;
  stamp.isa = SHOAL_ISA_AVX2 | SHOAL_ISA_FMA;
  return stamp;
}
constexpr std::uint32_t v3 = SHOAL_ISA_AVX2 | SHOAL_ISA_FMA;

}  // namespace

TEST_CASE("minors of one major meet in both directions; majors never") {
  const shoal_stamp stamp = sound_stamp();
  CHECK_FALSE(check_stamp(stamp, 4, 2, v3));
  CHECK_FALSE(check_stamp(stamp, 4, 9, v3));  // the plugin is older
  CHECK_FALSE(check_stamp(stamp, 4, 0, v3));  // the plugin is newer
  for (const unsigned major : {3u, 5u}) {
    const auto problem = check_stamp(stamp, major, 1, v3);
    REQUIRE(problem);
    CHECK(problem->problem == LoadProblem::abi_major);
    CHECK(problem->text == "was built for version 4.2 of the plugin interface, this Shoal has version " +
                               std::to_string(major) + ".1");
  }
}

TEST_CASE("a longer stamp of a later minor serves; one that is too short does not") {
  shoal_stamp stamp = sound_stamp();
  stamp.size = sizeof(shoal_stamp) + 64;
  CHECK_FALSE(check_stamp(stamp, 4, 2, v3));
  stamp.size = sizeof(shoal_stamp) - 1;
  CHECK(check_stamp(stamp, 4, 2, v3)->problem == LoadProblem::bad_stamp);
  stamp.size = 16;
  CHECK(check_stamp(stamp, 4, 2, v3)->text == "has a damaged stamp: it is too short to hold a version");
  // Of another major not even the length can be judged, only the version.
  stamp.size = 40;
  CHECK(check_stamp(stamp, 5, 0, v3)->problem == LoadProblem::abi_major);
}

TEST_CASE("instruction sets that are missing are named, with a preset that runs here") {
  CHECK(isa_problem(v3, v3).empty());
  CHECK(isa_problem(0, 0).empty());
  CHECK(isa_problem(v3 | SHOAL_ISA_AVX512F | SHOAL_ISA_AVX512VL, v3) ==
        "was built for a processor with AVX-512F, AVX-512VL, which this machine does not have; build it here "
        "with "
        "'cmake --preset release && cmake --build --preset release', or with the preset 'portable', which "
        "needs AVX2 "
        "and FMA alone");
  CHECK(isa_problem(v3, SHOAL_ISA_FMA) ==
        "was built for a processor with AVX2, which this machine does not have; build it here with 'cmake "
        "--preset "
        "release && cmake --build --preset release' (the preset 'portable' needs AVX2 and FMA, which are "
        "missing here "
        "too)");
  CHECK(isa_problem(1u << 20, ~0u).empty());
  CHECK(isa_text(SHOAL_ISA_AVX512DQ | SHOAL_ISA_AVX512BW | 1u << 9) == "AVX-512DQ, AVX-512BW, bit 9");
}

TEST_CASE("the machine has what this test was compiled for") {
#ifdef __AVX2__
  CHECK((isa_of_machine() & SHOAL_ISA_AVX2) != 0);
#endif
#ifdef __FMA__
  CHECK((isa_of_machine() & SHOAL_ISA_FMA) != 0);
#endif
#ifdef __AVX512F__
  CHECK((isa_of_machine() & SHOAL_ISA_AVX512F) != 0);
#endif
  CHECK(isa_problem(isa_of_machine(), isa_of_machine()).empty());
}

TEST_CASE("versions are three numbers, compared from the left") {
  CHECK(parse_version("1.2.3")->numbers == std::array<unsigned, 3>{1, 2, 3});
  CHECK(*parse_version("1.2") == *parse_version("1.2.0"));
  CHECK(*parse_version("2") > *parse_version("1.99.99"));
  CHECK(*parse_version("1.10.0") > *parse_version("1.9.9"));
  for (const char* text : {"", "1.", ".1", "1..2", "1.2.3.4", "v1", "1.2-rc", "1.2.3 ", "-1", "99999999999"})
    CHECK_MESSAGE(!parse_version(text), text);
  const Version version = *parse_version("1.2.0");
  CHECK(unmet({}, version).empty());
  CHECK(unmet({"1.2.0", "1.2.1"}, version).empty());
  CHECK(unmet({"1.2.1", ""}, version) == "at least 1.2.1");
  CHECK(unmet({"", "1.2.0"}, version) == "a version below 1.2.0");
  CHECK(unmet({"latest", ""}, version) == "at least latest");
}
