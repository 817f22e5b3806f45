// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Plugins of a case: what is said where one cannot be had, and what is then not said.
#include "kernel/case/catalogue.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "kernel/case/shapes.hpp"

namespace {

using namespace shoal::kernel;

struct Folder {
  std::filesystem::path path = std::filesystem::absolute("catalogue_plugins");
  Folder() {
    std::filesystem::remove_all(path);
    std::filesystem::create_directory(path);
    std::ofstream(path / "fluid.so") << "this is no library";
  }
  ~Folder() { std::filesystem::remove_all(path); }
};

TEST_CASE("a plugin that cannot be had is reported at its place, and its types are not") {
  const Folder folder;
  SearchSettings settings;
  settings.command_line = {folder.path};
  Loader loader(settings);
  Registry registry;
  Diagnostics diagnostics;
  const CaseFile file(
      "shoal: 1\nplugins: [fluit, fluid]\ndimensions: 2\nresolution: 1\n"
      "bodies: {water: {shape: nowhere, material: {fluid.liquid: {densty: 1}}}}\n"
      "physics: [fluit.flow, gas.flow]\nrun: {end: 1}\n",
      "a.yaml", ".", {}, diagnostics);
  const RegistryCatalogue catalogue = load_plugins(file, loader, registry, diagnostics);
  check_case(file, catalogue, diagnostics);
  const std::vector<Diagnostic> all = diagnostics.sorted();
  INFO(diagnostics.format());
  REQUIRE(all.size() == 4);
  CHECK(all[0].place.text() == "a.yaml:2:11");
  CHECK(all[0].message.find("fluit") != std::string::npos);
  CHECK(all[0].message.find("did you mean 'fluid'?") != std::string::npos);
  CHECK(all[1].place.text() == "a.yaml:2:18");
  CHECK(all[1].message.find("fluid") != std::string::npos);
  CHECK(all[2].message == "unknown shape 'nowhere'");
  CHECK(all[3].message == "unknown physics 'gas.flow'; there is no plugin 'gas' that could provide it");
  CHECK(catalogue.is_excused("fluid"));
  CHECK(catalogue.is_excused("fluid.liquid"));
  CHECK_FALSE(catalogue.is_excused("fluids.liquid"));
}

TEST_CASE("the types of a registry are found, with the original that objects point to") {
  Registry registry(check_parameter);
  registry.add_own(own_shape_types());
  const RegistryCatalogue catalogue(registry, {"solid"});
  CHECK(catalogue.names(SHOAL_TYPE_SHAPE) == registry.names(SHOAL_TYPE_SHAPE));
  CHECK_FALSE(static_cast<bool>(catalogue.find(SHOAL_TYPE_MATERIAL, "box")));
  const TypeEntry box = catalogue.find(SHOAL_TYPE_SHAPE, "box");
  REQUIRE(static_cast<bool>(box));
  CHECK(box.table->name == std::string("box"));
  CHECK(box.table != box.original);
  CHECK(box.table->n_parameters == box.original->n_parameters);
  CHECK(catalogue.explain_unknown(SHOAL_TYPE_MATERIAL, "solid.elastic").find("'solid'") != std::string::npos);
}

}  // namespace
