// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The checkpoints of a results folder: each is whole or absent, and the last two are kept, so that a kill while one
// is written, or damage to the newest, costs no more than the time since the one before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace shoal::kernel {

class CheckpointStore {
 public:
  static constexpr std::size_t kept = 2;

  /// `folder` is made when the first one is written.
  explicit CheckpointStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `header` says what is needed to go on beside the state of the simulation, which `body` writes. Throws
  /// OutputError, CheckpointError.
  std::filesystem::path write(std::uint64_t step, const std::string& header,
                              const std::function<void(std::ostream&)>& body);
  /// Whole files by their names; those that a kill left unfinished are not among them.
  std::vector<std::filesystem::path> newest_first() const;
  /// Those that are newer than `path`: of a future that a resumed run does not have.
  void remove_newer_than(const std::filesystem::path& path) const;

  /// Hands the header and a stream at the beginning of the body to `reader`. Throws CheckpointError if the header is
  /// damaged or of another version.
  static void read(const std::filesystem::path& path,
                   const std::function<void(const std::string& header, std::istream& body)>& reader);

 private:
  std::filesystem::path folder_;
};

}  // namespace shoal::kernel
