// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The list of a body's pictures with their times, as a PVD file: what a user opens in ParaView.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace shoal::vtk {

// "water_00012.vtp"
std::string picture_name(const std::string& body, std::uint64_t sequence);

class TimeSeries {
 public:
  // Keeps what <folder>/<body>.pvd lists of pictures before `resumed_sequence`, as far as they are still there; 0
  // keeps nothing. Throws std::runtime_error if the file is there but cannot be understood.
  TimeSeries(const std::filesystem::path& folder, std::string body, std::uint64_t resumed_sequence);

  // Adds a picture (or replaces that of the same sequence number) and writes the file atomically. Throws
  // WriteFailed.
  void add(std::uint64_t sequence, double time);

  // Removes the body's pictures in the folder that have a number of `resumed_sequence` or more and are not listed:
  // an interrupted run left them.
  void remove_forgotten() const;

 private:
  void read(std::uint64_t resumed_sequence);

  std::filesystem::path folder_;
  std::string body_;
  std::uint64_t resumed_sequence_;
  std::map<std::uint64_t, std::string> times_;  // as text, so that what was read is written again unchanged
};

}  // namespace shoal::vtk
