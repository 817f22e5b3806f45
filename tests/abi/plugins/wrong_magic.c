// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its stamp does not begin as one.
#define PLUGIN_ID "wrong_magic"
#define STAMP_MAGIC 42
#include "base.h"
