// SPDX-License-Identifier: Apache-2.0
// Records what is needed to show a run again: ground, poses, forces and loose soil over time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/math.h"
#include "record/replay_frames.h"
#include "record/row_file.h"
#include "session/session.h"

namespace navvy::record {

/// Writes replay.jsonl (docs/reference/results.md, "Replay"): a header, then rows for frames and
/// pictures, each one JSON object.
///
/// A frame costs a pass over the particles; between frames a call costs nothing. The size of a
/// frame follows from what changed: changed tiles of the ground, poses, and at most kMostParticles
/// particles.
class ReplayRecorder {
 public:
  /// Frames per simulated second, and frames between two that hold all changed tiles.
  static constexpr double kRate = 5;
  static constexpr std::uint64_t kKeyEvery = 50;
  /// Particles in a frame: of more that are in the air, in buckets and in beds, every n-th.
  static constexpr std::size_t kMostParticles = 500;

  /// Prepares the file `path` for `session`, which must outlive this object.
  ReplayRecorder(const session::Session& session, std::string path);

  /// Adds a frame if one is due in the present step. Must be called after each step.
  /// @throws FileError if the file cannot be written.
  void observe();
  /// Adds a row for a picture: number `number` of the camera called `camera`, from the pose X_WC.
  /// @throws FileError if the file cannot be written.
  void add_picture(const std::string& camera, std::uint64_t number, const Pose& X_WC);
  /// Adds a frame with all tiles that ever changed, after the world was put into another state.
  /// @throws FileError if the file cannot be written.
  void restart();
  /// Adds a frame of the end, unless the last one shows it.
  /// @throws FileError if the file cannot be written.
  void finish();
  /// Writes waiting rows; with `sync`, waits until they are stored on the disk.
  /// @throws FileError if the file cannot be written.
  void checkpoint(bool sync) { sync ? file_.sync() : file_.flush(); }
  /// Continues in a new file at `path`, which gets a copy of all rows.
  /// @throws FileError if the rows cannot be copied.
  void move_to(const std::string& path) { file_.move_to(path); }

 private:
  /// Adds a frame of the present state; `key`: with all tiles that ever changed.
  void add_frame(bool key);

  const session::Session& session_;
  ReplayFrames frames_;
  RowFile file_;
  /// Number of frames so far.
  std::uint64_t count_ = 0;
  std::uint64_t last_step_ = 0;
};

}  // namespace navvy::record
