// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The table of a probe on disk: CSV, one row per sample, written as the run goes, cut back to a checkpoint when a run
// is resumed so that the file becomes what it would have been without the interruption.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::kernel {

struct Column {
  std::string name;
  std::string unit;  ///< empty where none is known
};

class SeriesFile {
 public:
  /// A new file with the line of headers "time [s],front [m]". Throws OutputError.
  SeriesFile(std::filesystem::path path, const std::vector<Column>& columns);
  /// Goes on with a file of which the first `bytes` are kept. Throws OutputError if it is shorter, or if its headers
  /// are not those of `columns`.
  SeriesFile(std::filesystem::path path, const std::vector<Column>& columns, std::uint64_t bytes);
  SeriesFile(SeriesFile&& other) noexcept;
  SeriesFile& operator=(SeriesFile&&) = delete;
  ~SeriesFile();

  const std::filesystem::path& path() const { return path_; }
  /// A row is written at once: other programs may follow the file. Numbers have as many digits as give them back.
  void append(double time, const std::vector<double>& values);
  std::uint64_t bytes() const { return bytes_; }
  /// Forces the rows to the disk: before a checkpoint that counts on them.
  void sync();

 private:
  void open(int flags);
  void write(const std::string& text);

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t bytes_ = 0;
};

/// A table of numbers: rows of the same length under names.
struct Table {
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
};

/// Reads CSV: lines that begin with # and empty lines are comments; a first line that is not all numbers holds names.
/// Separators are commas, semicolons or blanks; an empty cell is NaN. Throws OutputError with file and line.
Table read_table(const std::filesystem::path& path);

}  // namespace shoal::kernel
