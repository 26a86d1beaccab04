// SPDX-License-Identifier: Apache-2.0
// Resting contact of a tool that stands still on the ground. It supports the tool when the soil
// below becomes columns.
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

/// Rigid contact at the vertices on which a tool stands. It replaces the force of
/// the soil once the ground has carried the tool for a while, and lasts until the tool moves or is
/// loaded much more than at the start [docs/tools.md, resting contact].
///
/// Particles near a tool stay active, and columns exert no force on tools. Without this contact a
/// tool on the ground would keep the soil below it active for ever. The ground under the contact
/// may be particles, columns or both.
struct RestingContact {
  /// Time for which the tool has stood still [s].
  double still = 0;
  /// True while this contact carries the tool.
  bool engaged = false;
  /// Pose of the tool when the contact started; before that, its pose at the last call of
  /// has_settled.
  Pose X_WT = Pose::Identity();
  /// Unit normal in W of the ground below, when the contact started.
  Vec3 up = Vec3::UnitZ();
  /// Component of the soil's force on the tool along `up` when the contact started [N].
  double initial_load = 0;
  /// Current force on the tool along `up`, averaged over about a tenth of a second [N].
  double load = 0;
  /// Friction coefficient between tool and ground.
  double friction = 0;

  /// Updates `still` and returns true if the tool has stood still long enough. `seconds`: time
  /// since the last call; `force`: force of the soil on the tool [N].
  bool has_settled(const scene::Shell& shell, const ToolMotion& motion, double seconds,
                   const Vec3& force);
  /// Starts the contact if rigid contact at the tool's lowest vertices can exert the current force
  /// and moment of the soil on the tool; otherwise nothing changes. `force` [N]; `moment` about the
  /// tool's origin [N m]; `tangent`: friction coefficient; `cell`: edge of a cell [m]; `normal`:
  /// unit normal of the ground below.
  void start(const scene::Shell& shell, const ToolMotion& motion, const Vec3& force,
             const Vec3& moment, double tangent, double cell, const Vec3& normal);
  /// Adds the impulse of the contact in a step of dt [s] to `impulse`, which must already contain
  /// all other impulses of the soil. Ends the contact if the tool has moved or is overloaded, and
  /// returns true in that case only.
  bool apply(const scene::Shell& shell, const ToolMotion& motion, double dt, double cell,
             ToolImpulse& impulse);
  /// Ends the contact.
  void release() { *this = RestingContact{}; }

  /// Visits all members, because later steps depend on them.
  void visit(Archive& a);
};

/// Returns two orthogonal unit vectors in the plane of ground with unit normal `up`: the x and y
/// axes of W on level ground; on a slope the direction of steepest descent and a horizontal one.
std::array<Vec3, 2> along_ground(const Vec3& up);

/// Returns the vertices that a tool stands on, in the tool's frame [m]: among the lowest vertices
/// along `up` those that are farthest in eight directions along the ground. `cell`: edge of a cell
/// [m].
std::vector<Vec3> contact_vertices(const scene::Shell& shell, const Pose& X_WT, double cell,
                                   const Vec3& up);

/// Returns the unit normal of ground with gradient (dz/dx, dz/dy) under a tool of horizontal length
/// `across` [m]. Ground that rises by less than a quarter of a cell over that length counts as
/// level, so that the unevenness of particles does not tilt the normal.
Vec3 normal_under(const Vec2& gradient, double across, double cell);

}  // namespace navvy::soil
