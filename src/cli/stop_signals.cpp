// SPDX-License-Identifier: Apache-2.0
#include "cli/stop_signals.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "cli/exit_code.h"
#include "device/kernel_cache.h"
#include "record/last_words.h"

namespace navvy::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

// A handler may do no more than this: count, and wake the thread through a pipe.
std::atomic<int> signals{0};
int wake[2] = {-1, -1};
struct sigaction before[3];

extern "C" void on_stop(int) {
  ++signals;
  const char byte = 0;
  // A full pipe holds enough to wake whoever reads it.
  if (::write(wake[1], &byte, 1) < 0) return;
}

[[noreturn]] void leave() {
  record::leave_last_words("interrupted",
                           "stopped from outside while the OpenCL driver was busy: it compiles kernels or does not "
                           "answer; results are those of the last checkpoint");
  std::fputs("interrupted: the OpenCL driver is busy and is not waited for\n", stderr);
  device::abandon_kernel_cache();
  _exit(kInterrupted);
}

}  // namespace

StopSignals::StopSignals() {
  signals = 0;
  if (pipe2(wake, O_CLOEXEC | O_NONBLOCK) != 0) wake[0] = wake[1] = -1;
  struct sigaction action = {};
  action.sa_handler = on_stop;
  action.sa_flags = SA_RESTART;
  for (int i = 0; i < 3; ++i) {
    sigaction(kSignals[i], nullptr, &before[i]);
    if (kSignals[i] == SIGHUP && before[i].sa_handler == SIG_IGN) continue;
    sigaction(kSignals[i], &action, nullptr);
  }
  watcher_ = std::thread([this] { watch(); });
}

StopSignals::~StopSignals() {
  over_ = true;
  const char byte = 0;
  if (::write(wake[1], &byte, 1) < 0) over_ = true;  // the thread looks up by itself
  watcher_.join();
  for (int i = 0; i < 3; ++i) sigaction(kSignals[i], &before[i], nullptr);
  ::close(wake[0]);
  ::close(wake[1]);
}

bool StopSignals::asked() { return signals > 0; }

void StopSignals::watch() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point first{};
  while (!over_) {
    pollfd in{wake[0], POLLIN, 0};
    // Asleep until a signal comes; from then on it looks often.
    poll(&in, 1, signals > 0 ? 50 : 1000);
    char bytes[64];
    while (::read(wake[0], bytes, sizeof bytes) > 0) {
    }
    if (over_ || signals == 0) continue;
    if (first == Clock::time_point{}) first = Clock::now();
    if (signals > 1 || (!obeyed_ && Clock::now() - first > std::chrono::milliseconds(kPatience))) leave();
  }
}

}  // namespace navvy::cli
