// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its file is named otherwise than itself.
#define PLUGIN_ID "real_name"
#include "base.h"
