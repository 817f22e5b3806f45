// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Requires ring_b, which requires ring_c, which requires this.
#define PLUGIN_ID "ring_a"
#define N_REQUIREMENTS 1
#define REQUIREMENTS requirements
#include <stddef.h>

#include "shoal/abi.h"
static const shoal_requirement requirements[] = {
    {.size = sizeof(shoal_requirement), .id = "ring_b", .minimum_version = NULL, .below_version = NULL}};
#include "base.h"
