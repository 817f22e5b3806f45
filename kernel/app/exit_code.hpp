// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// What the program's end tells the shell.
#pragma once

namespace shoal::kernel::app {

inline constexpr int exit_done = 0;
inline constexpr int exit_program_failed = 1;
inline constexpr int exit_wrong_case = 2;
inline constexpr int exit_physics_failed = 3;
inline constexpr int exit_interrupted = 130;

}  // namespace shoal::kernel::app
