// SPDX-License-Identifier: Apache-2.0
// Lines and labels over the pictures of a run: joints, forces, loads, paths, a grid, one line of
// text.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "heightfield/terrain_view.h"
#include "scene/frame.h"
#include "scene/overlay.h"
#include "session/session.h"

namespace navvy::record {

/// Makes the overlays that a scene shows (scene::Scene::show) from the state of a session.
class OverlayBuilder {
 public:
  /// Stores a reference to `session`, which must outlive this object.
  explicit OverlayBuilder(const session::Session& session);
  /// Replaces `out` by the lines and labels of the session's current state. The overlays `payload`
  /// and `hud` cost a pass over the particles for each bucket and bed.
  void build(scene::FrameOverlay& out);

 private:
  bool shows(scene::Overlay overlay) const { return shown_.count(overlay) != 0; }
  void add_joints(int machine, scene::FrameOverlay& out) const;
  void add_hitches(scene::FrameOverlay& out) const;
  void add_forces(int machine, scene::FrameOverlay& out) const;
  void add_wheel_loads(int machine, scene::FrameOverlay& out) const;
  void add_payloads(int machine, scene::FrameOverlay& out) const;
  void add_person(int machine, scene::FrameOverlay& out) const;
  void add_stakes(int machine, scene::FrameOverlay& out) const;
  void add_paths(scene::FrameOverlay& out) const;
  void add_design(scene::FrameOverlay& out) const;
  void add_grid(scene::FrameOverlay& out) const;
  std::string caption() const;
  /// Returns the height of the columns at a point of the site in W [m].
  double ground(const Vec2& p_W) const;

  const session::Session& session_;
  std::set<scene::Overlay> shown_;
  /// The columns of the picture being made.
  std::optional<heightfield::TerrainView> terrain_;
  /// Size of each machine [m], which the lengths of its lines are in proportion to.
  std::vector<double> size_;
};

}  // namespace navvy::record
