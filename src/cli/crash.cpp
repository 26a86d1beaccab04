// SPDX-License-Identifier: Apache-2.0
#include "cli/crash.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>

#include "cli/exit_code.h"
#include "record/crash_summary.h"

namespace navvy::cli {
namespace {

/// Signals that end a process by a fault.
constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
// The process whose crashes are reported; 0 before that. A child made by fork() has none to report.
pid_t reported = 0;
// A separate stack for the handler, which works after a stack overflow.
alignas(16) char stack[64 << 10];

/// Returns true if `text` contains one of the words.
bool holds_any(const char* text, std::initializer_list<const char*> words) {
  for (const char* word : words)
    if (std::strstr(text, word) != nullptr) return true;
  return false;
}

/// Returns true for files of an OpenCL driver. The machine code of kernels counts, as the driver
/// made it.
bool is_driver(const char* file) {
  return holds_any(file, {"libpocl", "libOpenCL", "opencl", "amdocl", "igdrcl", "navvy/kernels",
                          "navvy-kernels"});
}

/// Returns true for libraries that only pass on faults of their callers.
bool is_between(const char* file) {
  return holds_any(file, {"libc.so", "libc-", "libstdc++", "libgcc", "libpthread", "ld-linux",
                          "libasan", "linux-vdso"});
}

/// Writes where this was called from: "abort inside the OpenCL driver, in libpocl.so.2". Returns
/// true if the driver is at fault.
bool blame(const char* what, int signal, char* text, std::size_t size) {
  Dl_info own{};
  dladdr(reinterpret_cast<void*>(&blame), &own);
  void* frames[64];
  const int count = backtrace(frames, 64);
  // Innermost file that is at fault.
  const char* where = nullptr;
  bool driver = false;
  // The first frames of our own are this function and its callers.
  bool handler = true;
  // Innermost frame first. Other libraries may work for the driver (LLVM compiles for it), so the
  // search ends only at our own code.
  for (int i = 0; i < count && !driver; ++i) {
    Dl_info info;
    const bool known = dladdr(frames[i], &info) != 0 && info.dli_fname != nullptr;
    handler = handler && known && info.dli_fbase == own.dli_fbase;
    if (handler || !known || is_between(info.dli_fname)) continue;
    if (where == nullptr) where = info.dli_fname;
    driver = is_driver(info.dli_fname);
    if (info.dli_fbase == own.dli_fbase) break;
  }
  // Without other frames it is a check of our own code.
  if (where == nullptr) where = own.dli_fname;
  const char* slash = where == nullptr ? nullptr : std::strrchr(where, '/');
  const char* name = slash != nullptr ? slash + 1 : where != nullptr ? where : "an unknown place";
  std::snprintf(text, size, "%s inside %s%s", what, driver ? "the OpenCL driver, in " : "", name);
  const std::size_t used = std::strlen(text);
  if (signal != 0) std::snprintf(text + used, size - used, " (signal %d)", signal);
  if (driver)
    std::strncat(
        text,
        "; its messages above may name the cause; check disk, memory, limits (ulimit -a) and the "
        "driver's version",
        size - std::strlen(text) - 1);
  return driver;
}

/// Prints a crash and writes the summary of the run, by system calls only: this runs in handlers.
void report(const char* text) {
  record::write_crash_summary("failed", text);
  const char* const parts[] = {"error: ", text, "\n"};
  for (const char* part : parts)
    if (::write(STDERR_FILENO, part, std::strlen(part)) < 0) break;
}

/// Handles a fatal signal. A fault of the driver has an exit status of its own; others are raised
/// again, so that the system ends the process as usual.
extern "C" void on_crash(int signal) {
  // A second crash while handling this one ends the process as the system does.
  for (const int one : kCrashes) std::signal(one, SIG_DFL);
  if (getpid() != reported) {
    raise(signal);
    return;
  }
  char text[512];
  const bool driver = blame(signal == SIGABRT ? "abort" : "crash", signal, text, sizeof text);
  report(text);
  if (driver) _exit(kDevice);
  raise(signal);
}

/// Prints a failed assertion as the C library does.
void print_assertion(const char* what, const char* file, unsigned line, const char* function) {
  char text[512];
  std::snprintf(text, sizeof text, "%s:%u: %s: assertion '%s' failed\n", file, line, function,
                what);
  if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
}

/// True once main is about to return.
std::atomic<bool> exit_expected{false};

/// Runs at exit. An exit before main returns comes from a library.
extern "C" void on_exit_of_others() {
  if (exit_expected) return;
  char text[512];
  const bool driver = blame("end of the process", 0, text, sizeof text);
  report(text);
  _exit(driver ? kDevice : kInternal);
}

/// Reports an abort and ends the process by SIGABRT, even where the signal is blocked.
[[noreturn]] void end_by_abort() {
  // Handled once: this may fail again, or in another thread at the same time.
  static std::atomic<bool> handled{false};
  if (!handled.exchange(true)) on_crash(SIGABRT);
  std::signal(SIGABRT, SIG_DFL);
  sigset_t wanted;
  sigemptyset(&wanted);
  sigaddset(&wanted, SIGABRT);
  pthread_sigmask(SIG_UNBLOCK, &wanted, nullptr);
  raise(SIGABRT);
  _exit(128 + SIGABRT);
}

}  // namespace

// These two replace the functions of the C library for all libraries of the process. LLVM, which
// drivers compile with, replaces our signal handlers at its first build. Its handlers return at an
// abort, and the C library then ends the process without our report.
extern "C" void abort() noexcept { end_by_abort(); }

extern "C" __attribute__((noreturn)) void __assert_fail(const char* what, const char* file,
                                                        unsigned line,  // NOLINT: its name
                                                        const char* function) noexcept {
  print_assertion(what, file, line, function);
  end_by_abort();
}

void install_crash_report() {
  reported = getpid();
  // The first call loads a library, which must not happen in a handler.
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
  std::atexit(on_exit_of_others);
}

void expect_exit() { exit_expected = true; }

}  // namespace navvy::cli
