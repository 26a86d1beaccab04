// SPDX-License-Identifier: Apache-2.0
#include "cli/crash.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstring>
#include <initializer_list>

#include "cli/exit_code.h"
#include "record/last_words.h"

namespace navvy::cli {
namespace {

constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
// A stack that ran over has no room for a handler.
alignas(16) char stack[64 << 10];

bool holds_any(const char* text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (std::strstr(text, word) != nullptr) return true;
  return false;
}

/// Machine code of kernels counts as the driver's: it made it.
bool is_driver(const char* file) {
  return holds_any(file, {"libpocl", "libOpenCL", "opencl", "amdocl", "igdrcl", "navvy/kernels", "navvy-kernels"});
}

/// These pass on what their callers did.
bool is_between(const char* file) {
  return holds_any(file, {"libc.so", "libc-", "libstdc++", "libgcc", "libpthread", "ld-linux", "libasan", "linux-vdso"});
}

extern "C" void on_crash(int signal) {
  // The second crash, in what follows, ends the process as the system does.
  for (const int one : kCrashes) ::signal(one, SIG_DFL);
  Dl_info own{};
  dladdr(reinterpret_cast<void*>(&on_crash), &own);
  void* frames[64];
  const int count = backtrace(frames, 64);
  const char* where = nullptr;  // innermost that is not between
  bool driver = false;
  // From the inside out, without this function; other libraries work for the driver (LLVM compiles for it) as long as
  // none of our own code lies between.
  for (int i = 1; i < count && !driver; ++i) {
    Dl_info info;
    if (dladdr(frames[i], &info) == 0 || info.dli_fname == nullptr || is_between(info.dli_fname)) continue;
    if (where == nullptr) where = info.dli_fname;
    driver = is_driver(info.dli_fname);
    if (info.dli_fbase == own.dli_fbase) break;
  }
  const char* slash = where == nullptr ? nullptr : std::strrchr(where, '/');
  const char* name = slash != nullptr ? slash + 1 : where != nullptr ? where : "an unknown place";
  char text[512];
  std::snprintf(text, sizeof text, "%s inside %s%s (signal %d)%s", signal == SIGABRT ? "abort" : "crash",
                driver ? "the OpenCL driver, in " : "", name, signal,
                driver ? "; its cause stands above if it told one; check disk, memory and the driver's version" : "");
  record::leave_last_words("failed", text);
  const char* const parts[] = {"error: ", text, "\n"};
  for (const char* part : parts)
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
  if (driver) _exit(kDevice);
  raise(signal);
}

}  // namespace

void install_crash_report() {
  // The first call loads a library, which a handler must not.
  void* frames[4];
  backtrace(frames, 4);
  stack_t own{};
  own.ss_sp = stack;
  own.ss_size = sizeof stack;
  sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;
  for (const int one : kCrashes) sigaction(one, &action, nullptr);
}

}  // namespace navvy::cli
