// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers as people read them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace shoal::kernel::app {

std::string count_text(std::uint64_t n);    ///< 950, 12 345, 1.23 million
std::string bytes_text(double bytes);       ///< 812 B, 12.3 MB, 1.2 GB
std::string duration_text(double seconds);  ///< 0.42 s, 12 s, 3 min 20 s, 2 h 05 min
std::string simulated_time_text(
    double seconds);  ///< four significant digits with ms, us where they fit better: 0.41 ms
std::string percent_text(double share);             ///< 12 %, 0.3 %, 2e-05 %
std::string significant(double value, int digits);  ///< as %.{digits}g
std::string last_word(const std::string& key);      ///< behind the last dot: acoustic_cfl

/// Columns with two blanks between them; the first `left` are aligned to the left, the others to the right.
std::string table(const std::vector<std::vector<std::string>>& rows, std::size_t left,
                  const std::string& indent);

}  // namespace shoal::kernel::app
