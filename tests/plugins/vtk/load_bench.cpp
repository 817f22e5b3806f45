// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What loading the plugin adds to the start of a run. A program of its own, without VTK in it.
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <chrono>
#include <cstdio>
#include <string>

TEST_CASE("loading the plugin with VTK") {
  const auto start = std::chrono::steady_clock::now();
  void* library = dlopen(SHOAL_PLUGINS_FOLDER "/vtk.so", RTLD_NOW | RTLD_LOCAL);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  INFO(std::string(library ? "" : dlerror()));
  REQUIRE(library != nullptr);
  std::printf("dlopen of vtk.so %.1f ms\n", 1e3 * seconds);
  CHECK(seconds < 1.0);
}
