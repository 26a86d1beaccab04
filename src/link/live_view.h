// SPDX-License-Identifier: Apache-2.0
// Shows a running simulation in browsers, and lets them pause and command it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "link/view_commands.h"
#include "link/view_feed.h"
#include "link/view_server.h"
#include "record/replay_frames.h"
#include "run/simulation.h"

namespace navvy::link {

/// Serves the live page of a simulation (docs/howto/view.md).
///
/// Takes a frame about kRate times per second of wall time, between two steps, as long as a page is
/// open; a frame that takes long makes them rarer, so that frames take at most kShare of the time.
/// Sending is the work of other threads, and no subscriber is waited for. Without commands the run
/// gives the same results as without a view. Not thread-safe.
class LiveView {
 public:
  /// Starts to serve on `port` of 127.0.0.1, 0 for a free one. `inputs_refused` is the reason why
  /// pages may set no inputs; empty if they may.
  /// @throws InputError for a port in use, or a build without HTTP.
  LiveView(run::Simulation& simulation, int port, const std::string& inputs_refused = "");
  /// Ends as `finish` does.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Checks that a view could be served on `port`. @throws InputError as the constructor.
  static void require_port(int port);
  /// Returns the address of the page.
  std::string address() const { return server_.address(); }

  /// Carries out commands, and waits while the run is paused or ahead of its pace. Must be called
  /// before each step. Returns early if `stop` returns true.
  void before_step(const std::function<bool()>& stop);
  /// Takes a frame if one is due. Must be called after each step.
  void after_step();
  /// Takes a frame after the state was replaced.
  void restart();
  /// Sends the last frame and ends the stream. Later calls do nothing.
  void finish();

  /// Frames per second of wall time, and the largest share of the time that they may take.
  static constexpr double kRate = 11, kShare = 0.04;
  /// Particles in a frame: of more that are in the air, in buckets and in beds, every n-th.
  static constexpr std::size_t kMostParticles = 2000;

 private:
  /// Carries out the commands that have arrived. Returns true if there were any.
  void obey();
  /// Returns how long the next step must wait for a command or its time [s].
  double waiting() const;
  /// Takes a frame; with `all`, with every tile that ever changed.
  void publish(bool all);
  /// Measures the speed of the run once a second.
  void measure();

  run::Simulation& simulation_;
  record::ReplayFrames frames_;
  std::shared_ptr<ViewFeed> feed_ = std::make_shared<ViewFeed>();
  ViewCommands commands_;
  /// Outputs whose values a frame contains: the measured value of each input that the page shows.
  std::vector<int> measured_;
  std::string page_;
  ViewServer server_;

  bool paused_ = false;
  /// Steps that a paused run may still take.
  long steps_ = 0;
  /// Simulated seconds per second; 0: as fast as possible.
  double pace_ = 0;
  /// Simulated time at which the pace was set or last met [s], and the time since then.
  double pace_time_ = 0;
  Stopwatch pace_watch_;
  /// Simulated time at the last measurement [s], the time since then, and the result.
  double speed_time_ = 0, speed_ = 0;
  Stopwatch speed_watch_;
  /// Time since the last frame, and how long that frame took [s].
  Stopwatch since_frame_;
  double cost_ = 0;
  /// True if something that pages show changed while no step was taken.
  bool changed_ = false;
  /// Number of subscribers that the last frame was taken for.
  std::uint64_t subscriptions_ = 0;
  /// Why the last input was refused; empty if it was not.
  std::string message_;
  bool finished_ = false;
};

}  // namespace navvy::link
