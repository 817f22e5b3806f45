// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its stamp ends before its last members.
#define PLUGIN_ID "short_stamp"
#define STAMP_SIZE 40
#include "base.h"
