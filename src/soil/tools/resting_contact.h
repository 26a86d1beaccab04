// SPDX-License-Identifier: Apache-2.0
// Resting contact of a tool that has come to rest on the ground; it supports the tool while its
// soil becomes columns.
#pragma once

#include <array>
#include <vector>

#include "core/math.h"
#include "scene/machine.h"
#include "soil/tools/tool_motion.h"

namespace navvy {
class Archive;
}

namespace navvy::soil {

/// Rigid contact at the feet of a tool that stands on ground which has carried it. It lasts as long
/// as the tool neither moves nor weighs much more than when it came to rest
/// [docs/tools.md, resting contact].
///
/// Particles near a tool stay active, and columns know no tool. Without this contact a tool that
/// lies on the ground would keep its soil active for ever. The contact does not depend on soil: the
/// ground under it may be particles, columns or both.
struct RestingContact {
  /// Time that the tool has stood still [s].
  double still = 0;
  /// The contact carries the tool.
  bool engaged = false;
  /// Pose at which the tool came to rest; before, at the last look.
  Pose X_WT = Pose::Identity();
  /// Normal of the ground below, at the start of the contact.
  Vec3 up = Vec3::UnitZ();
  /// Force on the tool along the normal then [N].
  double initial_load = 0;
  /// Force of the contact, averaged over the last tenth of a second [N].
  double load = 0;
  /// Tangent of the friction angle.
  double friction = 0;

  /// Returns true if the tool has stood still long enough. `seconds`: time since the last call;
  /// `force`: of the soil on the tool [N].
  bool has_settled(const scene::Shell& shell, const ToolMotion& motion, double seconds,
                   const Vec3& force);
  /// Starts the contact if the tool's feet can exert what the soil exerts now: force [N] and moment
  /// [N m] about its origin. `normal`: of the ground below.
  void start(const scene::Shell& shell, const ToolMotion& motion, const Vec3& force,
             const Vec3& moment, double tangent, double cell, const Vec3& normal);
  /// Adds the impulse of the contact in a step of dt [s], after soil and all else have acted. Ends
  /// the contact if the tool moved or is overloaded; returns true then.
  bool apply(const scene::Shell& shell, const ToolMotion& motion, double dt, double cell,
             ToolImpulse& impulse);
  /// Ends the contact.
  void release() { *this = RestingContact{}; }

  /// Visits all of it: later steps depend on it.
  void visit(Archive& a);
};

/// Returns two directions along ground with this normal: W's axes on level ground, the fall line
/// and the horizontal on a slope.
std::array<Vec3, 2> along_ground(const Vec3& up);

/// Returns the vertices that stand on ground of this normal, in the tool's frame [m]: of the lowest
/// ones, the farthest in eight directions along the ground.
std::vector<Vec3> feet(const scene::Shell& shell, const Pose& X_WT, double cell, const Vec3& up);

/// Returns the normal of ground with this gradient under a tool of length `across` [m]. Ground
/// counts as level where it rises under the tool by less than feet may differ: unevenness of
/// particles must not tilt it.
Vec3 normal_under(const Vec2& gradient, double across, double cell);

}  // namespace navvy::soil
