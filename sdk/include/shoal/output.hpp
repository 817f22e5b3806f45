// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// An output: a type that writes snapshots of the run to files.
//
//     class Positions final : public shoal::Output {
//       Param<bool> header{"header", nullptr, "Whether to write names and units.", default_to(true)};
//       void begin(const Run& run) override { folder_ = run.folder; }
//       void write(const shoal_snapshot& snapshot) override { ... }
//       std::filesystem::path folder_;
//     };
//     SHOAL_PLUGIN(example, "1.0.0") { add<Positions>("example.positions", "Positions of all particles."); }
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "shoal/abi.h"
#include "shoal/host.hpp"
#include "shoal/parameters.hpp"
#include "shoal/snapshot.hpp"

namespace shoal {

// All calls are on the main thread. Files must be complete or absent at any moment: write under another name, then
// rename. Exceptions end the run with their text; what was written before must stay readable.
class Output : public Parameterised {
 public:
  static constexpr shoal_type_kind type_kind = SHOAL_TYPE_OUTPUT;

  struct Run {
    std::filesystem::path folder;  // where this output's files belong
    std::string title;             // of the case
    std::uint64_t resumed_sequence =
        0;  // number of the next snapshot; files of it and later ones are to be forgotten
  };

  virtual ~Output() = default;

  // Once, after the parameters were read.
  virtual void begin(const Run& run) = 0;
  // The views of the snapshot are valid during the call.
  virtual void write(const shoal_snapshot& snapshot) = 0;

  template <class Derived>
  static const void* api() {
    static const shoal_output_api table{
        sizeof(shoal_output_api), 0,
        [](const shoal_object* object, const char* folder, const char* title, std::uint64_t resumed_sequence,
           void** self) {
          return guarded([&] {
            auto output = std::make_unique<Derived>();
            // Vectors, which have as many numbers as the case has dimensions, make no sense here.
            output->read(*object, 0);
            static_cast<Output&>(*output).begin({folder, title ? title : "", resumed_sequence});
            *self = static_cast<Output*>(output.release());
          });
        },
        [](void* self) { delete static_cast<Output*>(self); },
        [](void* self, const shoal_snapshot* snapshot) {
          return guarded([&] { static_cast<Output*>(self)->write(*snapshot); });
        }};
    return &table;
  }

 protected:
  // The kernel acts on these four: it decides when `write` is called, and what is in the snapshot.
  Param<double> every{
      "every",  "s",      "Time between two snapshots, the first of which is the initial state.",
      positive, optional, example("50 ms")};
  Param<std::vector<double>> at{
      "at",         "s",      "Single times at which to write, beside those of `every`.",
      non_negative, optional, example("[0.1 s, 0.25 s]")};
  Param<std::vector<BodyIndex>> bodies{"bodies", nullptr, "Bodies to write; without it all.", optional,
                                       example("[water]")};
  Param<std::vector<FieldName>> fields{
      "fields", nullptr,
      "Fields, or components as velocity.x, to write beside position and id; without it the "
      "shared fields that a body has.",
      optional, example("[velocity, pressure]")};
};

}  // namespace shoal
