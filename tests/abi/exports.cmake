# SPDX-FileCopyrightText: The Shoal authors
# SPDX-License-Identifier: Apache-2.0
# cmake -DNM=nm -DFOLDER=folder -P exports.cmake: every plugin in the folder shows two symbols and no more. Any other
# one, and be it a template of the standard library, could be bound to another plugin's version of it.
file(GLOB plugins "${FOLDER}/*.so")
foreach(plugin IN LISTS plugins)
  execute_process(COMMAND "${NM}" -D --defined-only --format=posix "${plugin}" OUTPUT_VARIABLE output
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE " [^\n]*" "" symbols "${output}")
  string(REGEX REPLACE "\n" ";" symbols "${symbols}")
  list(REMOVE_ITEM symbols "")
  list(SORT symbols)
  if(NOT symbols STREQUAL "shoal_plugin_entry;shoal_plugin_stamp")
    string(REPLACE ";" "\n  " lines "${symbols}")
    message(SEND_ERROR "${plugin} must export shoal_plugin_entry and shoal_plugin_stamp alone, but exports:\n  ${lines}")
  endif()
endforeach()
if(NOT plugins)
  message(FATAL_ERROR "no plugins in ${FOLDER}")
endif()
