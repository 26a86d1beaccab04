// SPDX-License-Identifier: Apache-2.0
#include "run/stop_signals.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <iterator>
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
int quit_pipe[2] = {-1, -1}, caught_pipe[2] = {-1, -1};
sigset_t before;
struct sigaction before_action[std::size(kSignals)];

/// Passes a signal on to the thread that watches. Only threads that were there before the signals
/// were blocked get here.
void pass_on(int signal) {
  const int error = errno;
  const auto byte = static_cast<char>(signal);
  // A full pipe holds enough signals.
  const ssize_t ignored = ::write(caught_pipe[1], &byte, 1);
  static_cast<void>(ignored);
  errno = error;
}

/// Makes a pipe; both ends are -1 if there is none.
void open_pipe(int (&ends)[2]) {
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) ends[0] = ends[1] = -1;
}

}  // namespace

// The signals are blocked here, before any other thread inherits the mask, and read from a file by
// one thread. Handlers alone do not work: compilers inside drivers install their own, which delete
// the files that they write and pass the signal on, and the build then fails as if the kernels were
// wrong. A handler serves threads that libraries have started before `main`, as OpenBLAS does under
// GDAL: they take signals that all others have blocked.
StopSignals::StopSignals(Leave leave) : leave_(std::move(leave)) {
  signals = last = 0;
  open_pipe(quit_pipe);
  open_pipe(caught_pipe);
  sigset_t wanted;
  sigemptyset(&wanted);
  struct sigaction passes = {};
  passes.sa_handler = pass_on;
  passes.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    sigaction(kSignals[i], nullptr, &before_action[i]);
    if (kSignals[i] == SIGHUP && before_action[i].sa_handler == SIG_IGN) continue;
    sigaddset(&wanted, kSignals[i]);
    sigaction(kSignals[i], &passes, nullptr);
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
  if (!asked()) {
    for (std::size_t i = 0; i < std::size(kSignals); ++i)
      sigaction(kSignals[i], &before_action[i], nullptr);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    // A handler that still runs writes nowhere.
    for (int& file : caught_pipe) ::close(std::exchange(file, -1));
  }
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
    pollfd in[] = {{signals_, POLLIN, 0}, {quit_pipe[0], POLLIN, 0}, {caught_pipe[0], POLLIN, 0}};
    // Waits for a signal; after the first one it checks often.
    poll(in, std::size(in), signals > 0 ? 50 : 1000);
    signalfd_siginfo what{};
    bool came = false;
    while (::read(signals_, &what, sizeof what) == sizeof what) {
      came = true;
      last = static_cast<int>(what.ssi_signo);
      ++signals;
    }
    char caught = 0;
    while (::read(caught_pipe[0], &caught, 1) == 1) {
      came = true;
      last = caught;
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
