// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Made for fields in single precision.
#define PLUGIN_ID "other_sizes"
#define STAMP_REAL 4
#include "base.h"
