// SPDX-License-Identifier: Apache-2.0
// Reports crashes, and the library that caused them.
#pragma once

namespace navvy::cli {

/// Installs handlers that report a crash (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT) with the
/// library that caused it, and write a run summary with the status "failed".
///
/// After a crash inside the OpenCL driver, the process ends with the exit status kDevice. After
/// other crashes it ends as usual for the signal, with a core file where enabled. The handlers also
/// report a library that ends the process by calling exit, as compilers inside drivers do on a full
/// disk.
void install_crash_report();
/// Announces that main is about to return. Any exit before this call is reported as caused by a
/// library.
void expect_exit();

}  // namespace navvy::cli
