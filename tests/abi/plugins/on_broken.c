// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requires a plugin that cannot be loaded.
#define PLUGIN_ID "on_broken"
#define N_REQUIREMENTS 1
#define REQUIREMENTS requirements
#include <stddef.h>

#include "shoal/abi.h"
static const shoal_requirement requirements[] = {
    {.size = sizeof(shoal_requirement), .id = "newer_major", .minimum_version = NULL, .below_version = NULL}};
#include "base.h"
