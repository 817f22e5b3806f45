// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Units of the numbers in a case: "25 mm" becomes 0.025 where a length in m is wanted, and "2 kg" an error. Only
// units.cpp includes UDUNITS-2. Its database takes 5 ms to load, so it is loaded when the first unit occurs; a case
// of plain numbers never pays. All functions may be called from any thread, one at a time (they share a lock).
#pragma once

#include <stdexcept>
#include <string>

namespace shoal::kernel {

/// The unit is unknown or of another dimension. `what()` is a sentence for the user without a full stop.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `value` in unit `from` as a number in unit `wanted`, e.g. (20, "degC", "K") -> 293.15. Units are UDUNITS-2 texts
/// ("m2/s", "kg/m3", "Pa s"), "1" or "" without dimension; "deg" is the angle and superscripts are understood.
/// `shown` is the quantity as the user wrote it. Throws UnitError.
double convert_unit(double value, const std::string& from, const std::string& wanted,
                    const std::string& shown);

/// The SI unit of the same dimension: "m" for "mm", "m.s-1" for "km/h", "1" for "%". `shown` as above.
/// Throws UnitError if the unit is not known.
std::string si_unit(const std::string& unit, const std::string& shown);

/// Whether the text is a unit that is known.
bool is_unit(const std::string& unit);

/// Whether both are units of the same dimension.
bool same_dimension(const std::string& a, const std::string& b);

/// "a length (m)", "a pure number", or "a value in W/m2" for dimensions without a name of their own.
std::string described_unit(const std::string& unit);

}  // namespace shoal::kernel
