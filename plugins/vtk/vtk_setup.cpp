// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// A file of its own because vtkSMPTools.h of VTK 9.1 is not valid C++20: this one is compiled as C++17.
#include "vtk_setup.hpp"

#include <vtkObject.h>
#include <vtkSMPTools.h>

namespace shoal::vtk {

void set_up_vtk() {
  static const bool once = [] {
    vtkSMPTools::SetBackend("Sequential");
    vtkObject::GlobalWarningDisplayOff();
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace shoal::vtk
