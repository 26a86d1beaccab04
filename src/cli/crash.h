// SPDX-License-Identifier: Apache-2.0
// Reports which library caused a crash.
#pragma once

namespace navvy::cli {

/// Installs handlers that report crashes (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT) with the
/// library that caused them, and write the summary of the run as "failed". A crash inside the
/// OpenCL driver ends the process with the exit status of a failing device; others end it as the
/// system does, with a core file where enabled. A library that ends the process by itself is
/// reported, too: compilers within drivers do so on a full disk.
void install_crash_report();
/// Allows the process to end: main returns.
void expect_exit();

}  // namespace navvy::cli
