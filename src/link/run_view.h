// SPDX-License-Identifier: Apache-2.0
// Serves the page of a run from the run's folder, also while the run goes on.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "core/stopwatch.h"
#include "link/replay_follower.h"
#include "link/view_feed.h"
#include "link/view_server.h"

namespace navvy::link {

/// Serves the page of a run (docs/howto/view.md). While the run goes on, it is a live page that
/// follows replay.jsonl; afterwards it is the page that `navvy report` makes. The folder is only
/// read.
class RunView {
 public:
  /// Starts to serve the run in `folder` on `port` of 127.0.0.1, 0 for a free one.
  /// @throws InputError if the folder is none of a run, the port is in use, or Navvy was built
  /// without HTTP.
  RunView(std::string folder, int port);
  ~RunView();
  RunView(const RunView&) = delete;
  RunView& operator=(const RunView&) = delete;

  /// Returns the address of the page.
  std::string address() const { return server_->address(); }
  /// Hands new frames to the pages. Must be called about ten times per second.
  void step();

 private:
  /// Returns the page of the present state of the run.
  std::string page();
  /// Returns the frames of the run that the page shows.
  std::shared_ptr<ViewFeed> feed();
  /// Returns true if a run writes to the folder.
  bool is_running() const;
  /// Ends the stream if the run has ended or another one has begun.
  void end_if_over();

  std::string folder_;
  /// Guards the members below, which requests and `step` use.
  std::mutex mutex_;
  std::optional<ReplayFollower> follower_;
  std::shared_ptr<ViewFeed> feed_ = std::make_shared<ViewFeed>();
  Stopwatch since_check_;
  /// Last member, so that no request comes while the others are destroyed.
  std::unique_ptr<ViewServer> server_;
};

}  // namespace navvy::link
