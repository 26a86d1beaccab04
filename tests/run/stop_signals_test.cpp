// SPDX-License-Identifier: Apache-2.0
// Signals that end a run.
#include "run/stop_signals.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace navvy::run {
namespace {

using std::chrono::milliseconds;

/// Waits up to two seconds until a signal was received.
bool asked_soon() {
  for (int i = 0; i < 200 && !StopSignals::asked(); ++i)
    std::this_thread::sleep_for(milliseconds(10));
  return StopSignals::asked();
}

TEST(StopSignals, ReceivesASignalOfTheProcess) {
  StopSignals signals([](const char*) { std::abort(); });
  EXPECT_FALSE(StopSignals::asked());
  ::kill(::getpid(), SIGTERM);
  EXPECT_TRUE(asked_soon());
  signals.obeyed();
  EXPECT_EQ(StopSignals::name(), "SIGTERM");
}

// As libraries do that start threads before `main`.
TEST(StopSignals, ReceivesASignalThatAnEarlierThreadTakes) {
  // The test before has left its signals blocked, as a run does that ends.
  sigset_t all;
  sigemptyset(&all);
  sigaddset(&all, SIGINT);
  pthread_sigmask(SIG_UNBLOCK, &all, nullptr);
  std::atomic<bool> over = false;
  std::thread earlier([&] {
    while (!over) std::this_thread::sleep_for(milliseconds(10));
  });
  {
    StopSignals signals([](const char*) { std::abort(); });
    EXPECT_FALSE(StopSignals::asked());
    pthread_kill(earlier.native_handle(), SIGINT);
    EXPECT_TRUE(asked_soon());
    signals.obeyed();
    EXPECT_EQ(StopSignals::name(), "SIGINT");
  }
  over = true;
  earlier.join();
}

}  // namespace
}  // namespace navvy::run
