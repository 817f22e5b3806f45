// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Calls a function that nobody provides.
#define PLUGIN_ID "undefined_symbol"
#define OWN_ENTRY
#define WITHOUT_TYPES
#include "base.h"

extern const shoal_plugin* function_of_nobody(void);
extern EXPORT const shoal_plugin* shoal_plugin_entry(const shoal_host* host);
const shoal_plugin* shoal_plugin_entry(const shoal_host* host) {
  (void)host;
  return function_of_nobody();
}
