// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The output type `vtk` and its parameters.
#include <optional>

#include "pictures.hpp"
#include "shoal/output.hpp"
#include "shoal/plugin.hpp"

namespace shoal::vtk {

class VtkOutput final : public Output {
 public:
  void begin(const Run& run) override {
    pictures_.emplace(run.folder, run.resumed_sequence,
                      precision.value() == "double" ? Precision::full : Precision::single,
                      compression.value() == "none"    ? Compression::none
                      : compression.value() == "small" ? Compression::small
                                                       : Compression::fast);
  }
  void write(const shoal_snapshot& snapshot) override { pictures_->write(snapshot); }

 private:
  Param<Choice> precision{
      "precision",
      nullptr,
      "Numbers of 4 bytes (single), which is enough for pictures, or of 8 bytes (double), the "
      "precision of the computation.",
      one_of("single", "double"),
      default_to("single"),
      example("double")};
  Param<Choice> compression{
      "compression",
      nullptr,
      "fast: about a quarter smaller than none, at little cost; small: a fifth smaller still, but "
      "some fifteen times as slow; none: for programs that cannot read compressed files.",
      one_of("fast", "small", "none"),
      default_to("fast"),
      example("small")};

  std::optional<Pictures> pictures_;
};

}  // namespace shoal::vtk

SHOAL_PLUGIN(vtk, SHOAL_SDK_VERSION) {
  summary("Pictures of the particles for ParaView and other programs that read VTK files.");
  add<shoal::vtk::VtkOutput>(
      "vtk",
      "Writes the particles of each body as VTP files, and a PVD file per body that lists "
      "them with their times; open the latter in ParaView.");
}
