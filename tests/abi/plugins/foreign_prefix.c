// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Registers a type under the name of another plugin.
#define PLUGIN_ID "foreign_prefix"
#define PLUGIN_TYPE "good.type"
#include "base.h"
