// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The kernel's own types (shapes, probes) are described by the same members as those of plugins, so that cases,
// `shoal describe` and the schema know them alike.
#pragma once

#include <vector>

#include "shoal/abi.h"
#include "shoal/parameters.hpp"

namespace shoal::kernel {

/// The type `name` with the parameters of P, a shoal::Parameterised. All texts are literals. Built once.
template <class P>
const shoal_type* own_type(shoal_type_kind kind, const char* name, const char* doc, const void* api) {
  static const P prototype;
  static const std::vector<shoal_parameter> table = prototype.parameter_table();
  static const shoal_type type = [&] {
    shoal_type t{};
    t.size = sizeof(shoal_type);
    t.kind = static_cast<std::uint32_t>(kind);
    t.name = name;
    t.doc = doc;
    t.n_parameters = static_cast<std::uint32_t>(table.size());
    t.parameters = table.data();
    t.api = api;
    return t;
  }();
  return &type;
}

}  // namespace shoal::kernel
