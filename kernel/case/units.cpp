// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The only file that knows UDUNITS-2.
#include "kernel/case/units.hpp"

#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "kernel/case/diagnostics.hpp"

namespace shoal::kernel {
namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;
using Converter = std::unique_ptr<cv_converter, FreeConverter>;

std::mutex& lock() {
  static std::mutex mutex;
  return mutex;
}

ut_system* load_system() {
  // UDUNITS-2 would print by itself.
  ut_set_error_message_handler(ut_ignore);
  ut_system* system = ut_read_xml(nullptr);
  if (system == nullptr)
    throw UnitError("the units' database of UDUNITS-2 cannot be read; install the package libudunits2-data");
  // Everybody's word for the angle, missing from the database.
  const Unit degree(ut_parse(system, "arc_degree", UT_ASCII));
  ut_map_name_to_unit("deg", UT_ASCII, degree.get());
  return system;
}

// Lives until the process ends: units are converted until then.
ut_system* unit_system() {
  static ut_system* const system = load_system();
  return system;
}

// UDUNITS-2 understands single superscripts, but not "kg·m⁻³".
std::string ascii_unit(std::string text) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 16> replacements{{
      {"\u00B7", "."},
      {"\u22C5", "."},
      {"\u207B", "-"},
      {"\u2070", "0"},
      {"\u00B9", "1"},
      {"\u00B2", "2"},
      {"\u00B3", "3"},
      {"\u2074", "4"},
      {"\u2075", "5"},
      {"\u2076", "6"},
      {"\u2077", "7"},
      {"\u2078", "8"},
      {"\u2079", "9"},
      {"\u00B5", "u"},
      {"\u03BC", "u"},
      {"\u03A9", "ohm"},
  }};
  for (const auto& [from, to] : replacements) {
    for (std::size_t i = text.find(from); i != std::string::npos; i = text.find(from))
      text.replace(i, from.size(), to);
  }
  return text;
}

// Null if the text is not a unit. Origins ("m @ 5"), logarithms ("lg(re mW)") and time stamps ("s since 1970") are
// grammar of UDUNITS-2 that no case needs and a slip of the pen can reach.
Unit parse(const std::string& text) {
  const auto belongs = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return std::isalnum(byte) != 0 || byte >= 0x80U ||
           std::string_view(" _%.*/^-+'").find(c) != std::string_view::npos;
  };
  if (!std::all_of(text.begin(), text.end(), belongs) || text.find(" since ") != std::string::npos ||
      text.find(" from ") != std::string::npos)
    return nullptr;
  return Unit(ut_parse(unit_system(), ascii_unit(text).c_str(), UT_UTF8));
}

struct Dimension {
  const char* unit;
  const char* name;  // with its article
};

// Ordered: where two quantities share a dimension, the first gives the name.
constexpr std::array<Dimension, 33> dimensions{{
    {"1", "a pure number"},
    {"m", "a length"},
    {"s", "a time"},
    {"kg", "a mass"},
    {"K", "a temperature"},
    {"A", "an electric current"},
    {"mol", "an amount of substance"},
    {"cd", "a luminous intensity"},
    {"m2", "an area"},
    {"m3", "a volume"},
    {"m/s", "a velocity"},
    {"m/s2", "an acceleration"},
    {"1/s", "a rate"},
    {"1/m", "an inverse length"},
    {"kg/m3", "a density"},
    {"kg/m2", "a mass per area"},
    {"kg/s", "a mass flow"},
    {"m3/s", "a volume flow"},
    {"m2/s", "a kinematic viscosity or diffusivity"},
    {"Pa", "a pressure"},
    {"Pa s", "a dynamic viscosity"},
    {"N", "a force"},
    {"N/m", "a surface tension or stiffness"},
    {"J", "an energy"},
    {"W", "a power"},
    {"J/kg", "a specific energy"},
    {"J/kg/K", "a specific heat"},
    {"W/m/K", "a thermal conductivity"},
    {"V", "a voltage"},
    {"S/m", "an electric conductivity"},
    {"F/m2", "a capacitance per area"},
    {"C", "an electric charge"},
    {"mol/m3", "a concentration"},
}};

// Null if the dimensions differ. UDUNITS-2 also offers reciprocals (s from 1/s), which turn the order around.
Converter converter_between(ut_unit* from, ut_unit* to) {
  if (ut_are_convertible(from, to) == 0) return nullptr;
  Converter converter(ut_get_converter(from, to));
  const auto at = [&](double x) { return cv_convert_double(converter.get(), x); };
  return converter && at(2.0) > at(1.0) ? std::move(converter) : nullptr;
}

// "a length", or empty.
std::string dimension_name(ut_unit* unit) {
  for (const Dimension& dimension : dimensions) {
    const Unit reference = parse(dimension.unit);
    if (reference && converter_between(unit, reference.get())) return dimension.name;
  }
  return {};
}

std::string without_article(const std::string& name) { return name.substr(name.find(' ') + 1); }

std::string described(const std::string& text, ut_unit* unit) {
  if (ut_is_dimensionless(unit) != 0) return "a pure number";
  const std::string name = dimension_name(unit);
  return name.empty() ? "a value in " + text : name + " (" + text + ")";
}

const std::vector<std::string>& common_units() {
  static const std::vector<std::string> units{
      "m",    "cm",     "mm",     "km",    "um",    "kg",     "g",      "s",      "ms",   "us",
      "min",  "h",      "day",    "m/s",   "m/s2",  "Pa",     "kPa",    "MPa",    "GPa",  "bar",
      "atm",  "mmHg",   "N",      "kN",    "J",     "W",      "K",      "degC",   "Hz",   "deg",
      "rad",  "rpm",    "L",      "mL",    "mol",   "V",      "mV",     "A",      "S/m",  "Pa s",
      "m2/s", "kg/m3",  "N/m",    "%",     "metre", "meter",  "second", "minute", "hour", "kilogram",
      "gram", "pascal", "newton", "joule", "watt",  "kelvin", "degree", "radian"};
  return units;
}

}  // namespace

double convert_unit(double value, const std::string& from, const std::string& wanted,
                    const std::string& shown) {
  const std::lock_guard guard(lock());
  const Unit to = parse(wanted);
  if (!to) throw UnitError("the unit '" + wanted + "' of this parameter is not known to UDUNITS-2");
  const Unit unit = parse(from);
  if (!unit)
    throw UnitError("unknown unit '" + from + "' in '" + shown + "'" + did_you_mean(from, common_units()) +
                    " (expected " + described(wanted, to.get()) + ")");
  if (const Converter converter = converter_between(unit.get(), to.get()))
    return from == wanted ? value : cv_convert_double(converter.get(), value);
  const std::string name = dimension_name(unit.get());
  throw UnitError("expected " + described(wanted, to.get()) + ", got '" + shown + "'" +
                  (name.empty() ? std::string() : " (" + without_article(name) + ")"));
}

std::string si_unit(const std::string& unit, const std::string& shown) {
  const std::lock_guard guard(lock());
  const Unit parsed = parse(unit);
  if (!parsed)
    throw UnitError("unknown unit '" + unit + "' in '" + shown + "'" + did_you_mean(unit, common_units()));
  if (ut_is_dimensionless(parsed.get()) != 0) return "1";
  for (const Dimension& dimension : dimensions) {
    const Unit reference = parse(dimension.unit);
    if (reference && converter_between(parsed.get(), reference.get())) return dimension.unit;
  }
  // "1000 m-3.kg.s-1" in base units: the factor goes, the units stay.
  std::array<char, 256> buffer{};
  if (ut_format(parsed.get(), buffer.data(), buffer.size() - 1, UT_ASCII | UT_DEFINITION) < 0) return unit;
  std::string text = buffer.data();
  if (const std::size_t at = text.find(" @ "); at != std::string::npos) text.erase(at);
  return text.substr(text.find(' ') == std::string::npos ? 0 : text.find(' ') + 1);
}

bool is_unit(const std::string& unit) {
  const std::lock_guard guard(lock());
  return parse(unit) != nullptr;
}

bool same_dimension(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const std::lock_guard guard(lock());
  const Unit first = parse(a);
  const Unit second = parse(b);
  return first && second && converter_between(first.get(), second.get());
}

std::string described_unit(const std::string& unit) {
  if (unit.empty() || unit == "1") return "a pure number";
  const std::lock_guard guard(lock());
  const Unit parsed = parse(unit);
  return parsed ? described(unit, parsed.get()) : "a value in " + unit;
}

}  // namespace shoal::kernel
