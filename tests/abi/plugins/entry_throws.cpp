// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its entry lets an exception out, which the C++ layer of the SDK would have stopped.
#include <stdexcept>

#include "shoal/abi.h"

#define EXPORT extern "C" __attribute__((visibility("default")))

EXPORT const shoal_stamp shoal_plugin_stamp;
const shoal_stamp shoal_plugin_stamp = {
    SHOAL_ABI_MAGIC, sizeof(shoal_stamp), SHOAL_ABI_MAJOR, SHOAL_ABI_MINOR, 8, 4, 0, "", ""};

EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host*) {
  throw std::runtime_error("out of the entry");
}
