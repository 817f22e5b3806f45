// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Registers a kind of type that its own version of the interface does not have.
#define PLUGIN_ID "unknown_kind"
#define TYPE_KIND 17
#include "base.h"
