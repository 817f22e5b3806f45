// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Needs an instruction set that nobody has heard of.
#define PLUGIN_ID "other_isa"
#define STAMP_ISA (1u << 31)
#include "base.h"

#include <stdlib.h>
__attribute__((constructor)) static void must_not_run(void) { abort(); }
