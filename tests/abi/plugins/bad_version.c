// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its version is a word.
#define PLUGIN_ID "bad_version"
#define PLUGIN_VERSION "latest"
#include "base.h"
