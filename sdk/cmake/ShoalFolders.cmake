# SPDX-FileCopyrightText: The Shoal authors
# SPDX-License-Identifier: Apache-2.0
# Small helpers of this tree's own build; not installed.
include_guard(GLOBAL)

# The names of the folders directly below the current one.
function(shoal_subfolders variable)
  file(GLOB entries RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*")
  set(folders)
  foreach(entry IN LISTS entries)
    if(IS_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/${entry}")
      list(APPEND folders "${entry}")
    endif()
  endforeach()
  set(${variable} ${folders} PARENT_SCOPE)
endfunction()
