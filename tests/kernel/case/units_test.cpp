// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Conversion of units and the names of dimensions.
#include "kernel/case/units.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <thread>
#include <vector>

namespace {

using namespace shoal::kernel;

double convert(double value, const char* from, const char* wanted) {
  return convert_unit(value, from, wanted, "?");
}

std::string problem(double value, const char* from, const char* wanted, const char* shown) {
  try {
    convert_unit(value, from, wanted, shown);
  } catch (const UnitError& error) {
    return error.what();
  }
  return {};
}

TEST_CASE("quantities become numbers in the wanted unit") {
  CHECK(convert(2, "cm", "m") == doctest::Approx(0.02).epsilon(1e-14));
  CHECK(convert(25, "mm", "m") == 0.025);
  CHECK(convert(1, "atm", "Pa") == doctest::Approx(101325).epsilon(1e-14));
  CHECK(convert(5, "%", "1") == doctest::Approx(0.05).epsilon(1e-14));
  CHECK(convert(20, "degC", "K") == doctest::Approx(293.15).epsilon(1e-14));
  CHECK(convert(90, "deg", "1") == doctest::Approx(std::numbers::pi / 2).epsilon(1e-14));
  CHECK(convert(90, "\xC2\xB0", "rad") == doctest::Approx(std::numbers::pi / 2).epsilon(1e-14));
  CHECK(convert(60, "rpm", "1/s") == doctest::Approx(2 * std::numbers::pi).epsilon(1e-14));
  CHECK(convert(1, "uF/cm2", "F/m2") == doctest::Approx(0.01).epsilon(1e-14));
  CHECK(convert(1,
                "\xC2\xB5"
                "F/cm\xC2\xB2",
                "F/m2") == doctest::Approx(0.01).epsilon(1e-14));
  CHECK(convert(3, "kg\xC2\xB7m\xE2\x81\xBB\xC2\xB3", "kg/m3") == 3);
  CHECK(convert(3, "kg m-3", "kg/m3") == 3);
  CHECK(convert(1, "mPa s", "Pa s") == doctest::Approx(1e-3).epsilon(1e-14));
  CHECK(convert(2, "hours", "s") == 7200);
  CHECK(convert(1, "mmHg", "Pa") == doctest::Approx(133.322387415).epsilon(1e-12));
}

TEST_CASE("a value in the wanted unit is not touched") {
  CHECK(convert(0.1, "m", "m") == 0.1);
  CHECK(convert(9.81, "m/s2", "m/s2") == 9.81);
}

TEST_CASE("other dimensions are refused by name") {
  CHECK(problem(2, "kg", "m", "2 kg") == "expected a length (m), got '2 kg' (mass)");
  CHECK(problem(2, "m", "1", "2 m") == "expected a pure number, got '2 m' (length)");
  CHECK(problem(2, "%", "m", "2 %") == "expected a length (m), got '2 %' (pure number)");
  CHECK(problem(2, "m", "W/m2", "2 m") == "expected a value in W/m2, got '2 m' (length)");
  CHECK(problem(2, "W/m2", "m", "2 W/m2") == "expected a length (m), got '2 W/m2'");
  // UDUNITS-2 would turn a frequency into a time by itself.
  CHECK(problem(2, "Hz", "s", "2 Hz") == "expected a time (s), got '2 Hz' (rate)");
  CHECK(problem(2, "s", "1/s", "2 s") == "expected a rate (1/s), got '2 s' (time)");
}

TEST_CASE("unknown units are refused, with a suggestion") {
  CHECK(problem(2, "Kg", "kg", "2 Kg") ==
        "unknown unit 'Kg' in '2 Kg'; did you mean 'kg'? (expected a mass (kg))");
  CHECK(problem(2, "foo", "m", "2 foo") == "unknown unit 'foo' in '2 foo' (expected a length (m))");
  // Grammar of UDUNITS-2 that no case means.
  for (const char* text : {"m @ 5", "s since 1970-01-01", "lg(re 1 mW)", "m from 3"}) {
    INFO(text);
    CHECK_FALSE(is_unit(text));
  }
}

TEST_CASE("units have names") {
  CHECK(described_unit("m") == "a length (m)");
  CHECK(described_unit("1") == "a pure number");
  CHECK(described_unit("rad") == "a pure number");
  CHECK(described_unit("m2/s") == "a kinematic viscosity or diffusivity (m2/s)");
  CHECK(described_unit("W/m2") == "a value in W/m2");
}

TEST_CASE("the SI unit of a dimension") {
  CHECK(si_unit("mm", "?") == "m");
  CHECK(si_unit("km/h", "?") == "m/s");
  CHECK(si_unit("%", "?") == "1");
  CHECK(si_unit("degC", "?") == "K");
  // Any dimension must give a unit to which, and from which, one can convert.
  for (const char* unit : {"kW/cm2", "mol/L/min", "degF", "mV/ms", "N m2"}) {
    INFO(unit);
    const std::string si = si_unit(unit, "?");
    CHECK(is_unit(si));
    CHECK(same_dimension(unit, si));
  }
  CHECK(convert(1, "kW/cm2", si_unit("kW/cm2", "?").c_str()) == doctest::Approx(1e7).epsilon(1e-14));
}

TEST_CASE("dimensions are compared without regard to scale") {
  CHECK(same_dimension("mm", "km"));
  CHECK(same_dimension("deg", "1"));
  CHECK_FALSE(same_dimension("m", "s"));
  CHECK_FALSE(same_dimension("s", "1/s"));
  CHECK_FALSE(same_dimension("m", "no_unit"));
}

TEST_CASE("threads may convert at the same time") {
  std::vector<std::thread> threads;
  std::vector<double> sums(4, 0.0);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    threads.emplace_back([&sums, k] {
      for (int n = 0; n < 200; ++n) sums[k] += convert_unit(n, "cm", "m", "?");
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) CHECK(sum == doctest::Approx(199.0));
}

}  // namespace
