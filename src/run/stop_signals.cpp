// SPDX-License-Identifier: Apache-2.0
#include "run/stop_signals.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <utility>

#include "core/long_work.h"
#include "device/kernel_cache.h"
#include "record/crash_summary.h"

namespace navvy::run {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// Signals that are closer than this count as one [ms]: `timeout` and other wrappers signal a
// process and then its group.
constexpr int kTwice = 500;

std::atomic<int> signals{0}, last{0};
int quit_pipe[2] = {-1, -1};
sigset_t before;

}  // namespace

// The signals are blocked here, before any other thread inherits the mask, and read from a file by
// one thread. Handlers do not work: compilers inside drivers install their own, which delete the
// files that they write and pass the signal on, and the build then fails as if the kernels were
// wrong.
StopSignals::StopSignals(Leave leave) : leave_(std::move(leave)) {
  signals = last = 0;
  if (pipe2(quit_pipe, O_CLOEXEC | O_NONBLOCK) != 0) quit_pipe[0] = quit_pipe[1] = -1;
  sigset_t wanted;
  sigemptyset(&wanted);
  for (const int signal : kSignals) {
    struct sigaction now = {};
    sigaction(signal, nullptr, &now);
    if (signal != SIGHUP || now.sa_handler != SIG_IGN) sigaddset(&wanted, signal);
  }
  pthread_sigmask(SIG_BLOCK, &wanted, &before);
  signals_ = signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK);
  // If no file can be opened, the signals keep their default effect.
  if (signals_ < 0) pthread_sigmask(SIG_SETMASK, &before, nullptr);
  watcher_ = std::thread([this] { watch(); });
}

StopSignals::~StopSignals() {
  over_ = true;
  const char byte = 0;
  if (::write(quit_pipe[1], &byte, 1) < 0) over_ = true;
  watcher_.join();
  // A second signal may still be pending and would end the process before it returns its status.
  if (!asked()) pthread_sigmask(SIG_SETMASK, &before, nullptr);
  for (const int file : {signals_, quit_pipe[0], quit_pipe[1]}) ::close(file);
}

bool StopSignals::asked() { return signals > 0; }

std::string StopSignals::name() {
  for (const auto& [signal, name] :
       {std::pair{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}})
    if (last == signal) return name;
  return "";
}

/// Runs beside the thread of the run, which may hang in the driver, so it touches no object of the
/// run. The kernel cache is left unfinished, as the driver may be writing to it.
void StopSignals::leave(bool again) {
  // The mark is set by the thread of the run, and names what it cannot leave. That thread may hold
  // any lock, so the texts are made without allocating memory.
  const char* work = long_work();
  if (work == nullptr) work = "the run was busy with a step or a file";
  char cause[256], message[256];
  std::snprintf(cause, sizeof cause,
                "stopped by a signal while %s; results are those of the last checkpoint", work);
  std::snprintf(message, sizeof message, "%s: the run does not wait for it", work);
  record::write_crash_summary(
      "interrupted",
      again ? "stopped by a second signal: what was not written by then is missing" : cause);
  device::abandon_kernel_cache();
  leave_(again ? "a second signal came: the run does not wait any longer" : message);
}

void StopSignals::watch() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point first{};
  while (!over_) {
    pollfd in[] = {{signals_, POLLIN, 0}, {quit_pipe[0], POLLIN, 0}};
    // Waits for a signal; after the first one it checks often.
    poll(in, 2, signals > 0 ? 50 : 1000);
    signalfd_siginfo what{};
    bool came = false;
    while (::read(signals_, &what, sizeof what) == sizeof what) {
      came = true;
      last = static_cast<int>(what.ssi_signo);
      ++signals;
    }
    if (over_ || signals == 0) continue;
    if (first == Clock::time_point{}) first = Clock::now();
    const auto since = Clock::now() - first;
    if (came && since > std::chrono::milliseconds(kTwice)) leave(true);
    if (!obeyed_ && since > std::chrono::milliseconds(kPatience)) leave(false);
  }
}

}  // namespace navvy::run
