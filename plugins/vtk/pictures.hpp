// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The pictures of a run: for each body and time a VTP file, and for each body a PVD file that lists them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "picture.hpp"
#include "picture_file.hpp"
#include "shoal/abi.h"
#include "time_series.hpp"

namespace shoal::vtk {

class Pictures {
 public:
  // `resumed_sequence`: the number of the next snapshot. Creates the folder if it is missing; touches nothing in it
  // before the first snapshot.
  Pictures(std::filesystem::path folder, std::uint64_t resumed_sequence, Precision precision,
           Compression compression);

  // A picture is in place before its list names it. Throws WriteFailed.
  void write(const shoal_snapshot& snapshot);

 private:
  void write(const shoal_snapshot& snapshot, const shoal_snapshot_body& body);

  std::filesystem::path folder_;
  std::uint64_t resumed_sequence_;
  Precision precision_;
  Compression compression_;
  std::map<std::string, TimeSeries> series_;  // of each body, by name
};

}  // namespace shoal::vtk
