// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// An ordinary library, with the entry alone.
#define PLUGIN_ID "no_stamp"
#define WITHOUT_STAMP
#include "base.h"
