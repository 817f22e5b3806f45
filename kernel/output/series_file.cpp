// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/output/series_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include "kernel/output/atomic_file.hpp"

namespace shoal::kernel {
namespace {

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";  // whatever its sign
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

// Names are texts of a case, e.g. the expression max(a, b).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return quoted + '"';
}

std::string headers(const std::vector<Column>& columns) {
  std::string line = "time [s]";
  for (const Column& column : columns) {
    const std::string unit = column.unit.empty() || column.unit == "1" ? "" : " [" + column.unit + "]";
    line += ',' + cell(column.name + unit);
  }
  return line + '\n';
}

std::vector<std::string> split(const std::string& line) {
  const bool commas = line.find(',') != std::string::npos;
  const bool semicolons = !commas && line.find(';') != std::string::npos;
  const char separator = commas ? ',' : semicolons ? ';' : ' ';
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    const bool blank = c == ' ' || c == '\t';
    if (!quoted && (c == separator || (separator == ' ' && blank))) {
      if (separator != ' ' || !cells.back().empty()) cells.emplace_back();
    } else if (c != '"' && c != '\r') {
      cells.back() += c;
    }
  }
  if (separator == ' ' && cells.back().empty()) cells.pop_back();
  for (std::string& text : cells) {
    const std::size_t first = text.find_first_not_of(" \t");
    text = first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
  }
  return cells;
}

bool parse(const std::string& text, double& value) {
  if (text.empty()) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  const char* first = text.data() + (text[0] == '+' ? 1 : 0);
  const char* last = text.data() + text.size();
  return std::from_chars(first, last, value).ptr == last;
}

}  // namespace

SeriesFile::SeriesFile(std::filesystem::path path, const std::vector<Column>& columns)
    : path_(std::move(path)) {
  open(O_CREAT | O_TRUNC);
  write(headers(columns));
}

SeriesFile::SeriesFile(std::filesystem::path path, const std::vector<Column>& columns, std::uint64_t bytes)
    : path_(std::move(path)) {
  std::string begin;
  if (std::ifstream stream(path_); stream) std::getline(stream, begin);
  if (begin + '\n' != headers(columns))
    throw OutputError("'" + path_.string() + "' does not hold the columns that the case asks for now");
  open(0);
  struct stat status {};
  if (::fstat(file_, &status) != 0 || static_cast<std::uint64_t>(status.st_size) < bytes)
    throw OutputError("'" + path_.string() + "' is shorter than it was at the checkpoint");
  if (::ftruncate(file_, static_cast<off_t>(bytes)) != 0)
    throw OutputError("cannot write '" + path_.string() + "': " + std::strerror(errno));
  bytes_ = bytes;
}

SeriesFile::SeriesFile(SeriesFile&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)), bytes_(other.bytes_) {}

SeriesFile::~SeriesFile() {
  if (file_ >= 0) ::close(file_);
}

void SeriesFile::open(int flags) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | flags, 0666);
  if (file_ < 0) throw OutputError("cannot write '" + path_.string() + "': " + std::strerror(errno));
}

void SeriesFile::write(const std::string& text) {
  std::string_view rest = text;
  while (!rest.empty()) {
    const ssize_t n = ::write(file_, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw OutputError("cannot write '" + path_.string() + "': " + std::strerror(errno));
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  bytes_ += text.size();
}

void SeriesFile::append(double time, const std::vector<double>& values) {
  std::string row = number_text(time);
  for (const double value : values) row += ',' + number_text(value);
  write(row + '\n');
}

void SeriesFile::sync() {
  if (::fsync(file_) != 0 && errno != EINVAL && errno != ENOTSUP)
    throw OutputError("cannot write '" + path_.string() + "': " + std::strerror(errno));
}

Table read_table(const std::filesystem::path& path) {
  std::istringstream stream(read_whole_file(path));
  Table table;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::vector<std::string> cells = split(line);
    std::vector<double> row(cells.size());
    bool numbers = true;
    std::size_t bad = 0;
    for (std::size_t k = 0; k < cells.size() && numbers; ++k) {
      numbers = parse(cells[k], row[k]);
      if (!numbers) bad = k;
    }
    const std::string place = path.string() + ":" + std::to_string(number) + ": ";
    if (!numbers && table.rows.empty() && table.names.empty()) {
      table.names = cells;
    } else if (!numbers) {
      throw OutputError(place + "'" + cells[bad] + "' is no number");
    } else {
      const std::size_t expected = !table.rows.empty() ? table.rows[0].size() : table.names.size();
      if (expected != 0 && row.size() != expected)
        throw OutputError(place + std::to_string(row.size()) + " columns where " + std::to_string(expected) +
                          " were expected");
      table.rows.push_back(std::move(row));
    }
  }
  if (table.rows.empty()) throw OutputError("'" + path.string() + "' holds no numbers");
  return table;
}

}  // namespace shoal::kernel
