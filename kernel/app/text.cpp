// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
#include "kernel/app/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernel/case/diagnostics.hpp"

namespace shoal::kernel::app {

std::string count_text(std::uint64_t n) {
  if (n >= 10'000'000) return fmt::format("{:.1f} million", static_cast<double>(n) * 1e-6);
  std::string digits = std::to_string(n);
  for (std::size_t at = digits.size(); at > 3 && n >= 10'000;) digits.insert(at -= 3, " ");
  return digits;
}

std::string bytes_text(double bytes) {
  if (bytes < 1e3) return fmt::format("{:.0f} B", bytes);
  if (bytes < 1e6) return fmt::format("{:.1f} kB", bytes * 1e-3);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes * 1e-6);
  return fmt::format("{:.2f} GB", bytes * 1e-9);
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  if (seconds < 9.95) return fmt::format("{:.2g} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string simulated_time_text(double seconds) {
  const double magnitude = std::abs(seconds);
  if (magnitude == 0.0 || magnitude >= 0.1) return fmt::format("{:.4g} s", seconds);
  if (magnitude >= 1e-4) return fmt::format("{:.3g} ms", seconds * 1e3);
  if (magnitude >= 1e-7) return fmt::format("{:.3g} us", seconds * 1e6);
  return fmt::format("{:.3g} s", seconds);
}

std::string percent_text(double share) {
  const double percent = 100.0 * share;
  if (!std::isfinite(percent)) return "-";
  if (percent != 0.0 && std::abs(percent) < 0.1) return fmt::format("{:.1g} %", percent);
  return std::abs(percent) < 9.95 ? fmt::format("{:.1f} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string significant(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

std::string last_word(const std::string& key) { return key.substr(key.rfind('.') + 1); }

std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t left,
                  const std::string& indent) {
  std::vector<int> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], display_width(row[k]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string padding(static_cast<std::size_t>(widths[k] - display_width(row[k])), ' ');
      line += (k == 0 ? "" : "  ") + (k < left ? row[k] + padding : padding + row[k]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace shoal::kernel::app
