// SPDX-FileCopyrightText: The Shoal authors
// SPDX-License-Identifier: Apache-2.0
//
// Ctrl-C, or a batch system that wants its nodes back: the run finishes its step and writes a checkpoint. A second
// signal ends the program at once.
#pragma once

namespace shoal::kernel::app {

/// From now on SIGINT and SIGTERM are remembered. Once.
void watch_interrupts();
bool interrupted();

}  // namespace shoal::kernel::app
