// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that appear under their names only when they are complete: neither a kill, a full disk nor a power failure
// leaves half a file, or harms the one that stood there before.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace shoal::vtk {

// A file could not be written. The text names it and the system's reason.
struct WriteFailed : std::runtime_error {
  WriteFailed(const std::filesystem::path& file, int system_error);
};

class AtomicFile {
 public:
  // The content goes to `temporary`, a hidden file in the target's folder. It should be the same for all files of a
  // series: then what a killed run left is overwritten by the next one.
  AtomicFile(std::filesystem::path target, const std::string& temporary_name);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& target() const { return target_; }
  const std::filesystem::path& temporary() const { return temporary_; }

  // To be called after the temporary file was written and closed. Waits for the disk.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

void write_atomically(const std::filesystem::path& target, const std::string& temporary_name,
                      std::string_view content);

}  // namespace shoal::vtk
