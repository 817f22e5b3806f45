// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading structs whose maker may have known a shorter or a longer version of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "shoal/abi.h"

namespace shoal::kernel {

/// Element `index` of an array that a plugin made: its elements lie as far apart as its maker's struct is
/// long.
template <class Struct>
const Struct* abi_element(const Struct* array, std::size_t index) {
  if (index == 0) return array;
  const auto* bytes = reinterpret_cast<const std::byte*>(array);
  return reinterpret_cast<const Struct*>(bytes + index * static_cast<std::size_t>(array->size));
}

/// A copy in the layout of this kernel: what the maker did not know is zero, what we do not know is left
/// behind.
template <class Struct>
Struct abi_copy(const Struct* source) {
  Struct copy{};
  std::memcpy(static_cast<void*>(&copy), source,
              std::min(sizeof(Struct), static_cast<std::size_t>(source->size)));
  copy.size = static_cast<std::uint32_t>(sizeof(Struct));
  return copy;
}

/// Sizes of the structs in version 1.0 of the ABI: no maker can have known shorter ones. (On 64-bit machines;
/// these numbers stay as they are when the structs grow.)
template <class Struct>
inline constexpr std::uint32_t abi_smallest = 0;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_stamp> = 112;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_plugin> = 72;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_requirement> = 32;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_type> = 56;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_parameter> = 88;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_physics_api> = 16;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_material_api> = 32;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_shape_api> = 40;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_output_api> = 32;
template <>
inline constexpr std::uint32_t abi_smallest<shoal_probe_api> = 48;

}  // namespace shoal::kernel
