// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// VTK as a guest in a program that has threads and messages of its own.
#pragma once

namespace shoal::vtk {

// From now on VTK works on the caller's thread alone (threads are the kernel's) and prints nothing: errors come as
// codes. To be called before VTK is used; costs nothing when repeated.
void set_up_vtk();

}  // namespace shoal::vtk
