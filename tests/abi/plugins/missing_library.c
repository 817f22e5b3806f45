// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Linked with a library that is taken away before it is loaded.
#define PLUGIN_ID "missing_library"
#include "base.h"

extern int function_of_company(void);
extern EXPORT int use_company(void);
int use_company(void) { return function_of_company(); }
