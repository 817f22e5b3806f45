// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The struct of its type is shorter than any version of the interface had it.
#define PLUGIN_ID "short_type"
#define TYPE_SIZE 24
#include "base.h"
