// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A case that is damaged at random is either still a case or gives messages with a place: no mutation may crash the
// reader, throw, or pass with values missing. Worth running under the address sanitizer.
#include <doctest/doctest.h>

#include <cstdlib>
#include <random>

#include "kernel/case/effective.hpp"
#include "kernel/case/model.hpp"
#include "test_types.hpp"

// UDUNITS-2 2.2.28 loses the last word of a unit that its grammar refuses, some bytes each.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the sanitizer's name
extern "C" const char* __lsan_default_suppressions() { return "leak:libudunits2"; }

namespace {

using namespace shoal::kernel;

const std::string whole =
    "shoal: 1\n"
    "plugins: [fluid]\n"
    "dimensions: 2\n"
    "parameters: {H: 1 m, dx: 25 mm, U: 2*H}\n"
    "resolution: $dx\n"
    "domain: {lower: [0, 0], upper: [H, inf], periodic: [x]}\n"
    "x-wall: &wall {material: fluid.wall, resolution: 0.5}\n"
    "bodies:\n"
    "  water:\n"
    "    shape: {box: {lower: [0, 0], upper: [2*H, H]}}\n"
    "    material: {fluid.liquid: {density: 1000, permeability: [[1, 0], [0, 1]], free_surface: true}}\n"
    "    initial: {velocity: ['U*y/H', 0], pressure: 1 atm}\n"
    "  tank: {<<: *wall, shape: {shell: {of: {ball: {radius: 5 m}}, thickness: 4*dx}}}\n"
    "physics:\n"
    "  - fluid.wcsph: {bodies: [water], walls: [tank], inflow: ['1 - y^2', 0], heating: sin(x*t)}\n"
    "run: {end: 2 s, time_step_factors: {acoustic: 50 %}}\n"
    "output:\n"
    "  - vtk: {every: 50 ms, fields: [velocity]}\n"
    "probes:\n"
    "  front: {maximum: {of: position.x, body: water}, every: 5 ms}\n"
    "reference:\n"
    "  - {probe: front, exact: 2*t, tolerance: 5 %}\n";

std::string mutated(std::mt19937& random) {
  static const std::vector<std::string> pieces{
      "{",  "}", "[", "]", ":", ": ",   ",",    "\n",  "  ",    "\t",   "'",    "\"", "*",    "&",  "!",
      "#",  "|", ">", "%", "@", "-",    "- ",   "010", "1e999", ".nan", "null", "~",  "true", "no", "$",
      "()", "(", ")", "x", "H", "2 kg", "\xC3", "\0",  "<<: ",  "? ",   "---",  "^",  "/0",   "é"};
  std::string text = whole;
  const int n = 1 + static_cast<int>(random() % 3);
  for (int k = 0; k < n; ++k) {
    const std::size_t at = random() % text.size();
    const std::size_t length = std::min<std::size_t>(random() % 8, text.size() - at);
    switch (random() % 4) {
      case 0: text.erase(at, length); break;
      case 1: text.insert(at, pieces[random() % pieces.size()]); break;
      case 2: text.replace(at, length, pieces[random() % pieces.size()]); break;
      default: text.insert(at, text.substr(random() % text.size(), random() % 40)); break;
    }
  }
  return text;
}

TEST_CASE("damaged cases are refused with a place, or are cases") {
  const char* wanted = std::getenv("SHOAL_MUTATIONS");
  const int n = wanted != nullptr ? std::atoi(wanted) : 500;
  std::mt19937 random(20240229);
  const test::TestTypes types;
  int n_good = 0;
  for (int k = 0; k < n; ++k) {
    const std::string text = mutated(random);
    INFO(text);
    Diagnostics diagnostics;
    const CaseFile file(text, "a.yaml", ".", {}, diagnostics);
    std::unique_ptr<CaseModel> model;
    if (file.readable()) model = check_case(file, types, diagnostics);
    const std::string shown = diagnostics.format();
    CHECK((model != nullptr || diagnostics.has_errors()));
    for (const Diagnostic& item : diagnostics.sorted()) {
      INFO(shown);
      CHECK_FALSE(item.message.empty());
      CHECK(item.place.file().rfind("a.yaml", 0) == 0);
    }
    if (diagnostics.has_errors()) continue;
    ++n_good;
    CHECK(model->run.end > 0);
    CHECK(model->resolution > 0);
    Diagnostics again;
    const CaseFile effective(effective_case(*model), "effective.yaml", ".", {}, again);
    REQUIRE(effective.readable());
    check_case(effective, types, again);
    CHECK(again.format() == "");
  }
  // Neither kind is so rare that nothing is tested.
  CHECK(n_good > n / 50);
  CHECK(n_good < n / 2);
}

}  // namespace
