# SPDX-FileCopyrightText: The Shoal authors
# SPDX-License-Identifier: Apache-2.0
# find_package(VTK COMPONENTS ...) with Debian's libraries and unpacked headers. An installed libvtk9-dev
# (or any other VTK with its CMake files) comes first; but that package requires 500 others, from a Java
# compiler to a database, so the script `shoal` only unpacks its headers in build/packages.
find_package(VTK QUIET CONFIG COMPONENTS ${VTK_FIND_COMPONENTS})
if(VTK_FOUND)
  return()
endif()

find_path(VTK_INCLUDE_DIR vtkObject.h PATH_SUFFIXES vtk-9.1
          HINTS "${PROJECT_SOURCE_DIR}/build/packages/libvtk9-dev/usr/include")
set(required VTK_INCLUDE_DIR)
set(VTK_VERSION 9.1)
set(base CommonCore CommonDataModel CommonExecutionModel CommonMath CommonMisc sys)  # every module shows these
foreach(component IN LISTS VTK_FIND_COMPONENTS base)
  if(component STREQUAL "sys")
    set(file libvtksys-9.1.so.1)
  else()
    set(file "libvtk${component}-9.1.so.1")
  endif()
  find_library(VTK_${component}_LIBRARY NAMES ${file})
  list(APPEND required VTK_${component}_LIBRARY)
  if(VTK_${component}_LIBRARY AND VTK_INCLUDE_DIR AND NOT TARGET VTK::${component})
    add_library(VTK::${component} SHARED IMPORTED)
    set_target_properties(VTK::${component} PROPERTIES
      IMPORTED_LOCATION "${VTK_${component}_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${VTK_INCLUDE_DIR}")
    if(component IN_LIST VTK_FIND_COMPONENTS)
      set(VTK_${component}_FOUND TRUE)
      list(TRANSFORM base PREPEND VTK:: OUTPUT_VARIABLE base_targets)
      list(REMOVE_ITEM base_targets VTK::${component})
      set_property(TARGET VTK::${component} PROPERTY INTERFACE_LINK_LIBRARIES ${base_targets})
    endif()
    list(APPEND VTK_LIBRARIES VTK::${component})
  endif()
endforeach()
list(REMOVE_DUPLICATES VTK_LIBRARIES)
list(REMOVE_DUPLICATES required)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(VTK REQUIRED_VARS ${required} VERSION_VAR VTK_VERSION HANDLE_COMPONENTS
  REASON_FAILURE_MESSAGE "it comes with the packages of the component vtk in packages.txt")
