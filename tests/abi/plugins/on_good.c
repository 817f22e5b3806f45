// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requires a plugin that is there, in a version that serves.
#define PLUGIN_ID "on_good"
#define N_REQUIREMENTS 1
#define REQUIREMENTS requirements
#include <stddef.h>

#include "shoal/abi.h"
static const shoal_requirement requirements[] = {
    {.size = sizeof(shoal_requirement), .id = "good", .minimum_version = "1.0.0", .below_version = "2.0.0"}};
#include "base.h"
