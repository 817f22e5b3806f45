// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Shapes as a case writes them: the kernel's own types, their nesting, and those of plugins.
#pragma once

#include <vector>

#include "kernel/geometry/shape.hpp"
#include "shoal/abi.h"

namespace shoal::kernel {

/// box, ball, cylinder, polygon, half_space, shell, union, intersection, difference, transform.
const std::vector<const shoal_type*>& own_shape_types();

/// The shape of an object of a shape type, of the kernel or of a plugin. Throws ModelError with the place of what
/// cannot be, and the exceptions of call_plugin().
ShapePtr make_shape(const shoal_object& object, int dimensions);

}  // namespace shoal::kernel
