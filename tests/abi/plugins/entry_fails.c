// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Its entry says why it cannot start.
#define PLUGIN_ID "entry_fails"
#define OWN_ENTRY
#define WITHOUT_TYPES
#include "base.h"

extern EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host* host);
const shoal_plugin* shoal_plugin_entry(const shoal_host* host) {
  host->fail("no licence server answers");
  return NULL;
}
