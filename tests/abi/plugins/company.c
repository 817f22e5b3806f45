// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The library that missing_library needs.
extern __attribute__((visibility("default"))) int function_of_company(void);
int function_of_company(void) { return 1; }
