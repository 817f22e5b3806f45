// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// The commands of the program. Each gives its exit code; errors leave as exceptions and are told by main.cpp.
#pragma once

#include "kernel/app/options.hpp"

namespace shoal::kernel::app {

int run_case(const Options& options);
int resume_case(const Options& options);
int check_case_file(const Options& options);
int plan_case(const Options& options);
int study_case(const Options& options);
int write_report(const Options& options);
int describe(const Options& options);
int list_plugins(const Options& options);
int print_schema(const Options& options);

}  // namespace shoal::kernel::app
