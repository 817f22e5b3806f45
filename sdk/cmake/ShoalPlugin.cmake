# SPDX-FileCopyrightText: The Shoal authors
# SPDX-License-Identifier: Apache-2.0
# shoal_add_plugin(): how every plugin is built, in this tree and outside of it. It is installed beside
# ShoalConfig.cmake, so both ways use the same flags.
include_guard(GLOBAL)
include(CheckCXXCompilerFlag)

# shoal_compile_flags(VARIABLE [MARCH value]): the flags of numerical code.
#
# Arithmetic is strict IEEE but for three things that change no documented result:
#   -fno-math-errno      sqrt() becomes one instruction; nobody reads errno
#   -fno-trapping-math   nobody unmasks floating-point traps; lets both sides of a select be computed
#   -ffp-contract=fast   a*b+c may become one fused instruction (one rounding fewer). Which ones do is
#                        decided when compiling, so with one binary the result of a particle is the same on
#                        any number of threads and after a restart, as long as the same instructions treat
#                        it: the kernel's chunks depend on the range alone, and pair rows are padded, not
#                        finished by a scalar remainder. Between different -march or compilers the last
#                        bits differ anyway.
# -ffast-math never: NaN must stay visible, and sums must keep the order in which they are written.
function(shoal_compile_flags variable)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "MARCH" "")
  set(flags -fno-math-errno -fno-trapping-math -ffp-contract=fast)
  set(march "${SHOAL_MARCH}")
  if(arg_MARCH)
    set(march "${arg_MARCH}")
  elseif(NOT DEFINED SHOAL_MARCH)
    set(march native)
  endif()
  if(march)
    string(MAKE_C_IDENTIFIER "SHOAL_HAS_MARCH_${march}" has_march)
    check_cxx_compiler_flag("-march=${march}" ${has_march})
    if(${has_march})
      list(APPEND flags "-march=${march}")
    elseif(march STREQUAL "native")
      list(APPEND flags "-mcpu=native")  # clang on ARM
    else()
      message(FATAL_ERROR "The compiler ${CMAKE_CXX_COMPILER} does not know -march=${march} (SHOAL_MARCH).")
    endif()
  endif()
  set(${variable} ${flags} PARENT_SCOPE)
endfunction()

# shoal_add_plugin(NAME SOURCES file... [MARCH value] [LIBRARIES target...])
#
# Builds NAME.so, which `shoal` loads by that name, from C++20 sources that include <shoal/...>. The
# target is shoal_plugin_NAME; the file stands in <build>/plugins. Only the entry point of SHOAL_PLUGIN()
# is visible in it. MARCH is the instruction set; without it that of SHOAL_MARCH (default: native).
# `cmake --install` puts it where the installed program of the same ABI looks.
function(shoal_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "MARCH" "SOURCES;LIBRARIES")
  if(NOT arg_SOURCES OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "shoal_add_plugin(NAME SOURCES file... [MARCH value] [LIBRARIES target...]); "
                        "not understood for plugin '${name}': '${arg_UNPARSED_ARGUMENTS}'")
  endif()
  set(target "shoal_plugin_${name}")
  add_library(${target} MODULE ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE Shoal::sdk ${arg_LIBRARIES})
  target_compile_features(${target} PRIVATE cxx_std_20)
  shoal_compile_flags(flags MARCH "${arg_MARCH}")
  # Without a build type CMake would not optimise at all (measured: a pair loop is 20 times slower), with others -O2.
  target_compile_options(${target} PRIVATE ${flags} $<$<NOT:$<CONFIG:Debug>>:-O3>)
  set(map "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/plugin.map")
  target_link_options(${target} PRIVATE "-Wl,--version-script=${map}")
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${map}")
  # A symbol that is missing is an error now, not when a user loads the plugin (sanitizers leave theirs open).
  if(NOT SHOAL_SANITIZE)
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
  set_target_properties(${target} PROPERTIES
    OUTPUT_NAME "${name}" PREFIX "" SUFFIX ".so"
    C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/plugins")
  install(TARGETS ${target} LIBRARY DESTINATION "lib/shoal/plugins/abi-${SHOAL_ABI_MAJOR}" COMPONENT ${name})
endfunction()
