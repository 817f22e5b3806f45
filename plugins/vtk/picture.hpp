// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A body's particles as the data set that visualisation programs know: points, each with a vertex cell of its own
// (so that single particles can be selected and thresholded), and an array for each field.
#pragma once

#include <vtkSmartPointer.h>

#include "shoal/abi.h"

class vtkPolyData;

namespace shoal::vtk {

enum class Precision { single, full };

// Arrays are named as the fields. Vectors have 3 components, with zero for those that the case does not have;
// symmetric matrices have the 6 in VTK's order XX, YY, ZZ, XY, YZ, XZ, matrices 9 row by row. The ids become the
// array `id`, positions the points; a field `position` is not written twice. A body without particles has the same
// arrays, of length zero. Throws std::invalid_argument if a field does not have the components of its rank.
vtkSmartPointer<vtkPolyData> make_picture(const shoal_snapshot_body& body, int dimensions, double time,
                                          Precision precision);

}  // namespace shoal::vtk
