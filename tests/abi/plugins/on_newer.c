// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requires a newer version than there is.
#define PLUGIN_ID "on_newer"
#define N_REQUIREMENTS 1
#define REQUIREMENTS requirements
#include <stddef.h>

#include "shoal/abi.h"
static const shoal_requirement requirements[] = {
    {.size = sizeof(shoal_requirement), .id = "good", .minimum_version = "1.1.0", .below_version = NULL}};
#include "base.h"
