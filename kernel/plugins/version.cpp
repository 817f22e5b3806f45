// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading and comparing versions.
#include "kernel/plugins/version.hpp"

#include <charconv>

namespace shoal::kernel {

std::optional<Version> parse_version(std::string_view text) {
  Version version;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (std::size_t k = 0; k < version.numbers.size(); ++k) {
    const auto [stop, error] = std::from_chars(at, end, version.numbers[k]);
    if (error != std::errc() || stop == at) return std::nullopt;
    if (stop == end) return version;
    if (*stop != '.') return std::nullopt;
    at = stop + 1;
  }
  return std::nullopt;
}

std::string unmet(const VersionRange& range, const Version& version) {
  if (!range.at_least.empty()) {
    const auto bound = parse_version(range.at_least);
    if (!bound || version < *bound) return "at least " + range.at_least;
  }
  if (!range.below.empty()) {
    const auto bound = parse_version(range.below);
    if (!bound || version >= *bound) return "a version below " + range.below;
  }
  return {};
}

}  // namespace shoal::kernel
