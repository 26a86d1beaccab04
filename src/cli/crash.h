// SPDX-License-Identifier: Apache-2.0
// Says whose a crash was.
#pragma once

namespace navvy::cli {

/// From now on a crash (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT) says on standard error in which
/// library it was, and leaves the run's summary as "failed". One inside the OpenCL driver ends the
/// process with the status of a failing device, another as the system does by default, with a core
/// file where those are kept. The same for a library that ends the process by itself: compilers
/// within drivers do so on a full disk.
void install_crash_report();
/// From now on the process may end: main returns.
void expect_exit();

}  // namespace navvy::cli
