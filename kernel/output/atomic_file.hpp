// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Files that are whole or absent: written under another name, forced to the disk, then renamed. A kill or a power
// failure leaves the previous file.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace shoal::kernel {

/// A result cannot be written or read. what() names the file and the reason.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class AtomicFile {
 public:
  /// Opens `path` + ".part". Throws OutputError.
  explicit AtomicFile(std::filesystem::path path);
  /// Without commit() nothing is left behind.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  /// Puts the file in place. Throws OutputError, then the previous file is still there.
  void commit();

 private:
  std::filesystem::path path_, part_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// The same for a text at hand.
void write_atomically(const std::filesystem::path& path, std::string_view content);

/// Forces what was written to `path` to the disk (a folder: its list of names). Throws OutputError.
void sync_to_disk(const std::filesystem::path& path);

/// Throws OutputError.
void make_folder(const std::filesystem::path& folder);
std::string read_whole_file(const std::filesystem::path& path);

}  // namespace shoal::kernel
