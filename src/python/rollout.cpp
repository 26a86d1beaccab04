// SPDX-License-Identifier: Apache-2.0
// Rollouts: many copies of a world, each with its own controls, on several threads.
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

#include "core/saved_state.h"
#include "core/sealed.h"
#include "python/kept_messages.h"
#include "python/runner.h"

namespace navvy::python {
namespace {

/// The work of all threads of a rollout. Each member is computed by one thread from its own start,
/// so that the results do not depend on the number of threads.
class Crew {
 public:
  Crew(const RolloutPlan& plan, const std::vector<char>& state) : plan_(plan), state_(state) {}

  /// Takes members until none is left. Called by each thread with a world of its own.
  void work(LiveSession& live) {
    const QuietHere quiet;
    try {
      for (int member = next_++; member < plan_.members && !stop_; member = next_++)
        run(live, member);
    } catch (...) {
      const std::lock_guard<std::mutex> alone(mutex_);
      if (!error_) error_ = std::current_exception();
      stop_ = true;
    }
    const std::lock_guard<std::mutex> alone(mutex_);
    ++ended_;
    changed_.notify_all();
  }

  /// Waits until `threads` threads have ended; calls `poll` meanwhile. If that throws, the threads
  /// stop after their present row.
  void wait(int threads, const Runner::Poll& poll) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (ended_ < threads) {
      changed_.wait_for(lock, std::chrono::milliseconds(20));
      if (error_) continue;
      lock.unlock();
      try {
        poll();
        lock.lock();
      } catch (...) {
        lock.lock();
        error_ = std::current_exception();
        stop_ = true;
      }
    }
  }

  /// Returns the failures, by member. @throws what a thread or the poll has thrown.
  std::vector<Failure> result() {
    if (error_) std::rethrow_exception(error_);
    std::sort(failures_.begin(), failures_.end(),
              [](const Failure& a, const Failure& b) { return a.member < b.member; });
    return std::move(failures_);
  }

 private:
  /// Runs one member from its start to its last row.
  void run(LiveSession& live, int member) {
    const auto m = static_cast<std::size_t>(member);
    if (plan_.states.empty())
      live.load(state_);
    else
      live.session().restore(plan_.states[m]);
    int row = 0;
    try {
      for (; row < plan_.rows && !stop_; ++row) advance(live.session(), member, row);
    } catch (const SimulationError& error) {
      {
        const std::lock_guard<std::mutex> alone(mutex_);
        failures_.push_back({member, row, error.what()});
      }
      // A failed member holds its last state.
      for (; row < plan_.rows; ++row) record(live.session(), member, row);
    }
  }

  void advance(session::Session& session, int member, int row) {
    const std::size_t inputs = plan_.inputs.size();
    const double* control = plan_.controls + index(member, row) * inputs;
    for (std::size_t i = 0; i < inputs; ++i) session.set(plan_.inputs[i], control[i]);
    for (int s = 0; s < plan_.steps; ++s) session.step();
    record(session, member, row);
  }

  void record(const session::Session& session, int member, int row) {
    const std::size_t outputs = plan_.outputs.size();
    double* out = plan_.results + index(member, row) * outputs;
    for (std::size_t i = 0; i < outputs; ++i)
      out[i] = session.world().outputs().get(plan_.outputs[i]);
  }

  std::size_t index(int member, int row) const {
    return static_cast<std::size_t>(member) * static_cast<std::size_t>(plan_.rows) +
           static_cast<std::size_t>(row);
  }

  const RolloutPlan& plan_;
  const std::vector<char>& state_;
  std::atomic<int> next_ = 0;
  std::atomic<bool> stop_ = false;
  /// Guards the members below.
  std::mutex mutex_;
  std::condition_variable changed_;
  int ended_ = 0;
  std::exception_ptr error_;
  std::vector<Failure> failures_;
};

/// Checks all controls before a step is taken, so that a wrong number names its place.
void check_controls(const RolloutPlan& plan, const sim::Inputs& inputs) {
  const double* control = plan.controls;
  for (int member = 0; member < plan.members; ++member)
    for (int row = 0; row < plan.rows; ++row)
      for (const int input : plan.inputs) try {
          inputs.require(input, *control++);
        } catch (const InputError& error) {
          Fault fault = error.faults().front();
          fault.element = "controls[" + std::to_string(member) + ", " + std::to_string(row) +
                          "], input " + fault.element;
          throw InputError(fault);
        }
}

}  // namespace

void Runner::grow_pool(std::size_t size) {
  const QuietHere quiet;
  while (pool_.size() < size)
    pool_.push_back(std::make_unique<LiveSession>(world().description(), options_));
}

std::vector<Failure> Runner::rollout(const RolloutPlan& plan, const Poll& poll) {
  check_controls(plan, world().inputs());
  const int processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int threads =
      std::max(1, std::min(plan.workers > 0 ? plan.workers : processors, plan.members));
  grow_pool(static_cast<std::size_t>(threads));
  const std::vector<char> state = saved(session());
  Crew crew(plan, state);
  std::vector<std::thread> workers;
  for (int i = 0; i < threads; ++i)
    workers.emplace_back([&crew, &live = *pool_[static_cast<std::size_t>(i)]] { crew.work(live); });
  crew.wait(threads, poll);
  for (std::thread& one : workers) one.join();
  return crew.result();
}

}  // namespace navvy::python
