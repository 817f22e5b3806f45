// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A plugin that no case asks for: it must stay closed.
#include "shoal/shoal.hpp"

namespace {

struct Nothing : shoal::Material {};

}  // namespace

SHOAL_PLUGIN(idle, "1.0.0") {
  summary("Nothing, to test that it is not opened.");
  add<Nothing>("idle.nothing", "Nothing.");
}
