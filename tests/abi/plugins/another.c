// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A second sound plugin, which nobody asks for.
#define PLUGIN_ID "another"
#include "base.h"
