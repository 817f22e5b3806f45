// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Versions of plugins: three numbers, compared from the left.
#pragma once

#include <array>
#include <compare>
#include <optional>
#include <string>
#include <string_view>

namespace shoal::kernel {

struct Version {
  std::array<unsigned, 3> numbers{};
  auto operator<=>(const Version&) const = default;
};

/// "1.2.3"; numbers left out at the end are zero. Nothing if the text is anything else.
std::optional<Version> parse_version(std::string_view text);

/// Which versions serve: at least the first, below the second; empty texts do not bound.
struct VersionRange {
  std::string at_least;
  std::string below;
};

/// Empty if `version` lies in the range, else e.g. "at least 1.2.0" or "a version below 2.0.0".
/// A bound that is no version is never met.
std::string unmet(const VersionRange& range, const Version& version);

}  // namespace shoal::kernel
