// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Made for an interface of another meaning. Nothing of it may run.
#define PLUGIN_ID "newer_major"
#define STAMP_MAJOR (SHOAL_ABI_MAJOR + 1)
#define STAMP_MINOR 3
#include "base.h"

#include <stdlib.h>
__attribute__((constructor)) static void must_not_run(void) { abort(); }
