// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Where the particles of all bodies stand at the start.
#pragma once

#include <vector>

#include "kernel/case/model.hpp"
#include "kernel/geometry/shape.hpp"

namespace shoal::kernel {

/// The particles of each body of the model, in its order.
///
/// Each body has a lattice of its own that begins at the lower corner of its shape, so that boxes are filled to their
/// faces wherever they stand. Where bodies overlap, the one that comes first in the case wins: particles of a later
/// one that are nearer than half a spacing to an earlier one's are left out, with a warning that counts them. Relaxed
/// bodies are relaxed last, in the presence of the others. Throws ModelError, with the place in the case.
std::vector<std::vector<Point>> arrange_particles(const CaseModel& model, bool skip_relaxation);

}  // namespace shoal::kernel
