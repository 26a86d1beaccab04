// SPDX-License-Identifier: Apache-2.0
// A tool that has come to rest on the ground, and what bears it while its soil goes back to
// columns.
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

/// Where a tool stands on ground that has borne it: rows of a rigid contact at its feet, for as
/// long as it neither moves nor weighs much more than when it came to rest [docs/tools.md, seat].
///
/// Particles keep a tool awake and columns know no tool; without a seat one that lies down keeps
/// its soil awake for good. Nothing here knows of soil: the ground under a seat may be particles,
/// columns or both.
struct RestingContact {
  double still = 0;    ///< for how long the tool has stood [s]
  bool taken = false;  ///< it bears
  /// Where the tool came to rest; before, where it was last looked at.
  Pose X_WT = Pose::Identity();
  Vec3 up = Vec3::UnitZ();  ///< normal of the ground under it when it was taken
  double bears = 0;         ///< force on the tool along it then [N]
  double load = 0;          ///< mean of the last tenth of a second of what it gives [N]
  double friction = 0;      ///< tangent

  /// Whether the tool has stood still for long enough; `seconds` since it was asked last, `force`
  /// of the soil on it [N].
  bool stands(const scene::Shell& shell, const ToolMotion& motion, double seconds,
              const Vec3& force);
  /// Takes the seat where the tool's feet can give what the soil gives it now: force [N] and moment
  /// [N m] about its origin; `normal` of the ground under it.
  void take(const scene::Shell& shell, const ToolMotion& motion, const Vec3& force,
            const Vec3& moment, double tangent, double cell, const Vec3& normal);
  /// Adds what the ground gives the tool in a step of dt [s] after soil and all else have acted;
  /// lets go where it moved or is loaded by more than it bears. Whether it let go.
  bool hold(const scene::Shell& shell, const ToolMotion& motion, double dt, double cell,
            ToolImpulse& impulse);
  void let_go() { *this = RestingContact{}; }

  void visit(Archive& a);
};

/// Two ways along ground with this normal: level ground's are W's axes, a slope's the one that
/// falls and the one across.
std::array<Vec3, 2> along_ground(const Vec3& up);

/// Vertices that stand on ground of this normal [m], in the tool's frame: of those lowest along it
/// the farthest eight ways along the ground.
std::vector<Vec3> feet(const scene::Shell& shell, const Pose& X_WT, double cell, const Vec3& up);

/// Normal of the ground with this gradient under a tool that is `across` long [m]. Ground is level
/// where it rises under the tool by less than feet may differ: what particles leave uneven turns no
/// foot.
Vec3 normal_under(const Vec2& gradient, double across, double cell);

}  // namespace navvy::soil
