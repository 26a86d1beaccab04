// SPDX-License-Identifier: Apache-2.0
// What Coin and OSMesa keep until the process ends is theirs; our own leaks still fail the
// sanitizer's run.

// Called by LeakSanitizer when it is linked in; without it nobody calls this.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libCoin.so\nleak:libOSMesa.so\n";
}
