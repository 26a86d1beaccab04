// SPDX-License-Identifier: Apache-2.0
// The world that Python steps: a session that can be started again, saved, copied and rolled out.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "heightfield/cell_rect.h"
#include "python/errors.h"
#include "python/height_view.h"
#include "python/live_session.h"
#include "scene/scene.h"

namespace navvy::python {

/// A member of a rollout whose simulation failed.
struct Failure {
  int member = 0;       ///< index of the member
  int row = 0;          ///< index of the row of controls during which it failed
  std::string message;  ///< message of the error
};

/// Description of a rollout: controls for `members` copies of a world.
struct RolloutPlan {
  int members = 0;           ///< number of members, n
  int rows = 0;              ///< number of rows of controls, t
  int steps = 1;             ///< base steps per row
  int workers = 0;           ///< number of threads; 0: one per processor
  std::vector<int> inputs;   ///< index of the input of each control, k
  std::vector<int> outputs;  ///< index of each output that is recorded, m
  /// Controls, shape {n, t, k}; not copied.
  const double* controls = nullptr;
  /// Outputs after each row, shape {n, t, m}; written by `rollout`.
  double* results = nullptr;
  /// State that each member starts from, as bytes of a snapshot; empty: the state of the world.
  std::vector<std::vector<char>> states;
};

/// A session together with its scene and its initial state. One thread may be inside at a time;
/// a second one is refused (`Use`). After a failed step the world keeps its last state, and only
/// `reset` and `load` are allowed.
class Runner {
 public:
  /// Function that long work calls from time to time, in the thread that began it; it may throw to
  /// end the work.
  using Poll = std::function<void()>;

  /// Builds the world. Without `programs` the machines follow inputs only.
  Runner(scene::Scene scene, LiveSession::Options options, bool programs);
  /// Builds a copy of `other` in its present state; both are bit-identical from here on. The caller
  /// holds `other`.
  explicit Runner(Runner& other);

  /// Holds the world for one call.
  /// @throws BusyError if another thread is inside; ClosedError after `close`; device::DeviceError
  /// in a child of fork().
  class Use {
   public:
    explicit Use(Runner& runner);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Runner& runner_;
  };

  // All functions below expect that the caller holds the world by `Use`.
  /// Returns the session. @throws ClosedError after `close`.
  session::Session& session();
  const sim::World& world();
  /// Returns an object that keeps the session alive, for views of its arrays.
  std::shared_ptr<LiveSession> live() { return live_; }
  /// Takes `n` base steps; calls `poll` every few milliseconds.
  /// @throws SimulationError; also for a world that failed before.
  void step(int n, const Poll& poll);
  /// Returns to the start, with another seed if `seed` differs from that of the scene.
  void reset(const std::uint64_t* seed);
  /// Returns the bytes of a snapshot, as `navvy run` writes it.
  std::vector<char> save();
  /// Loads the bytes of a snapshot of the same scene. A failure leaves the state as it was.
  void load(const std::vector<char>& bytes, bool anyway);
  /// Copies the present state of this world into `other`, which has the same scene. The caller
  /// holds both.
  void copy_to(Runner& other);
  /// Rolls out copies of this world, whose state does not change. Returns the members that failed;
  /// their outputs keep the last values. Copies are kept for the next rollout.
  std::vector<Failure> rollout(const RolloutPlan& plan, const Poll& poll);
  /// Brings the heights of columns and loose soil up to date; returns the changed rectangles.
  std::vector<heightfield::CellRect> refresh_heights();
  /// Brings the heights of the columns alone up to date.
  std::vector<heightfield::CellRect> refresh_columns();
  const HeightView& heights() const { return heights_; }
  const HeightView& columns() const { return columns_; }
  /// Releases the session; all later calls are refused.
  void close();
  /// Returns the message of the step that failed; empty without a failure.
  const std::string& failure() const { return failure_; }

 private:
  friend class Use;
  /// Fills the pool up to `size` copies of this world.
  void grow_pool(std::size_t size);

  LiveSession::Options options_;
  std::shared_ptr<LiveSession> live_;
  /// Copies that `rollout` uses, one per worker.
  std::vector<std::unique_ptr<LiveSession>> pool_;
  HeightView heights_, columns_;
  std::string failure_;
  std::atomic<bool> busy_ = false;
};

}  // namespace navvy::python
