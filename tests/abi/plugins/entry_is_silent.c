// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its entry fails without a word.
#define PLUGIN_ID "entry_is_silent"
#define OWN_ENTRY
#define WITHOUT_TYPES
#include "base.h"

extern EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host* host);
const shoal_plugin* shoal_plugin_entry(const shoal_host* host) {
  (void)host;
  return NULL;
}
