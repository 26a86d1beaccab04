// SPDX-License-Identifier: Apache-2.0
// Suppresses leaks that Coin and OSMesa keep until the process ends; leaks of Navvy still fail the
// sanitizer's run.

// Called by LeakSanitizer if it is linked in.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libCoin.so\nleak:libOSMesa.so\n";
}
