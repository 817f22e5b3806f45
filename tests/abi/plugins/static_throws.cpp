// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// One of its static objects cannot be made: an exception while the library is mapped.
#include <stdexcept>

#include "shoal/abi.h"

#define EXPORT extern "C" __attribute__((visibility("default")))

namespace {
struct Fails {
  Fails() { throw std::runtime_error("out of a constructor"); }
} fails;
}  // namespace

EXPORT const shoal_stamp shoal_plugin_stamp;
const shoal_stamp shoal_plugin_stamp = {
    SHOAL_ABI_MAGIC, sizeof(shoal_stamp), SHOAL_ABI_MAJOR, SHOAL_ABI_MINOR, 8, 4, 0, "", ""};

EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host*) { return nullptr; }
