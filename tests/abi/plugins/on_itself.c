// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requires itself.
#define PLUGIN_ID "on_itself"
#define N_REQUIREMENTS 1
#define REQUIREMENTS requirements
#include <stddef.h>

#include "shoal/abi.h"
static const shoal_requirement requirements[] = {
    {.size = sizeof(shoal_requirement), .id = "on_itself", .minimum_version = NULL, .below_version = NULL}};
#include "base.h"
