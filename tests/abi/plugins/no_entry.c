// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// It has the stamp but no entry.
#define PLUGIN_ID "no_entry"
#define OWN_ENTRY
#define WITHOUT_TYPES
#include "base.h"
