// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Registers one type twice.
#define PLUGIN_ID "duplicate_type"
#define TYPES &type, &type
#include "base.h"
