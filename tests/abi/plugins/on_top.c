// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requires a plugin that requires another.
#define PLUGIN_ID "on_top"
#define N_REQUIREMENTS 1
#define REQUIREMENTS requirements
#include <stddef.h>

#include "shoal/abi.h"
static const shoal_requirement requirements[] = {
    {.size = sizeof(shoal_requirement), .id = "on_good", .minimum_version = NULL, .below_version = NULL}};
#include "base.h"
