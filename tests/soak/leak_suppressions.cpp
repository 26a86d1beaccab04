// SPDX-License-Identifier: Apache-2.0
// Suppresses leaks that the OpenCL driver and its compiler keep until the process ends; leaks of
// Navvy still fail a soak under the address sanitizer.

// Called by LeakSanitizer if it is linked in.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libpocl.so\nleak:libLLVM\nleak:libclang\nleak:libOpenCL.so\n";
}
