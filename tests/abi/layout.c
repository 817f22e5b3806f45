// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The contract as a C compiler sees it: that abi.h is C at all, and that its layout is the one that was promised.
#include "shoal/abi.h"
#include "shoal/interfaces/equation_of_state.h"
#include "shoal/interfaces/stress_law.h"

#define SIZE(struct_, bytes_) _Static_assert(sizeof(struct_) == (bytes_), "size of " #struct_);
#define MEMBER(struct_, member_, offset_, bytes_)                                              \
  _Static_assert(offsetof(struct_, member_) == (offset_), "place of " #struct_ "::" #member_); \
  _Static_assert(sizeof(((struct_*)0)->member_) == (bytes_), "size of " #struct_ "::" #member_);
#define VALUE(name_, value_) _Static_assert((name_) == (value_), "value of " #name_);
#include "interfaces.inc"
#include "layout.inc"

// SHOAL_HAS is used by plugins in C too.
int layout_has_evaluate(const shoal_host* host);
int layout_has_evaluate(const shoal_host* host) { return SHOAL_HAS(shoal_host, host, evaluate); }
