// SPDX-License-Identifier: Apache-2.0
// Tool forces of an excavator [ISO 6015]: the breakout force of its bucket cylinder and the
// tear-out force of its stick cylinder, and what limits them. Independent of the physics engine.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/math.h"
#include "scene/machine.h"

namespace navvy::vehicle {

/// Tool force by the cylinder that works: the bucket's (breakout) or the stick's (tear-out).
enum class ToolForceKind { kBreakout, kTearOut };

/// Condition that limits a tool force [ISO 6015]: a circuit reaches its relief pressure, the
/// machine begins to tip, or it slips on the ground.
enum class ForceLimit { kHydraulic, kTipping, kSlipping };
/// Returns the limit as a word: "hydraulic", "tipping" or "slipping".
const char* name_of(ForceLimit limit);

/// Tool force in one position of the arm, as the force of the cutting edge along its circle about
/// the pivot of the working joint.
struct RatedToolForce {
  /// Positions of the joints of boom, stick and bucket [rad].
  double boom = 0, stick = 0, bucket = 0;
  /// Position of the cutting edge: distance ahead of the swing axis, height above the ground [m].
  double reach = 0, height = 0;
  /// Distance of the cutting edge from the pivot of the working joint [m].
  double radius = 0;
  /// Force of the working circuit alone at its relief pressure, if all others held any load [N].
  double working = 0;
  /// Force at which the first circuit reaches its relief pressure [N]. The circuits of the other
  /// joints hold. Weights and friction of the arm are excluded, as in published tool forces.
  double hydraulic = 0;
  /// Name of the cylinder whose circuit reaches its relief pressure first.
  std::string circuit;
  /// Force at which the machine begins to tip, and force at which it slips with its brakes on [N];
  /// infinite if it does not.
  double tipping = std::numeric_limits<double>::infinity();
  double slipping = std::numeric_limits<double>::infinity();

  /// Returns the force that the machine applies without an anchor [N].
  double standing() const { return std::min({hydraulic, tipping, slipping}); }
  /// Returns what limits standing().
  ForceLimit limit() const;
};

/// Tool force of a machine over all positions of its arm, over its front.
struct ToolForceRating {
  /// The cylinder that works.
  ToolForceKind kind = ToolForceKind::kBreakout;
  /// Position of the largest hydraulic force, which is the rated tool force: where the machine tips
  /// or slips before, it must be anchored. Of equal positions, the one with the largest standing
  /// force.
  RatedToolForce rated;
  /// Position of the largest force of the working circuit alone; of equal ones, that with the
  /// largest hydraulic force. Data sheets that disregard the circuits that hold give this one.
  RatedToolForce alone;
  /// Position of the largest force that the machine applies without an anchor.
  RatedToolForce standing;
  /// Forces over the range of the working joint, with the other joints as in `rated`.
  std::vector<RatedToolForce> curve;
};

/// Returns the reason why a machine has no tool forces, or nothing: it needs a `navvy:arm` with
/// boom, stick and bucket, a `navvy:bucket` on that bucket, and for each of the three joints a
/// cylinder or an effort limit.
std::optional<Fault> tool_force_fault(const scene::Machine& machine);

/// Computes a tool force of `machine` over all positions of its arm. Takes about a second.
///
/// The force acts at the middle of the bucket's cutting edge (scene::Bucket::p_tip), as the
/// standard defines it; teeth ahead of the edge are left out. For the tear-out force the bucket is
/// where the breakout force is largest. Positions in which the edge is within the support polygon,
/// seen from above, do not count. The machine stands on level, firm ground with the friction of its
/// tyres or tracks, its wheels locked by its brakes, its oscillating axle locked.
/// @throws InputError with tool_force_fault().
ToolForceRating rate_tool_force(const scene::Machine& machine, ToolForceKind kind);

/// Returns the tool force in one position of the arm, joint positions in [rad].
/// @throws InputError with tool_force_fault().
RatedToolForce tool_force_at(const scene::Machine& machine, ToolForceKind kind, double boom,
                             double stick, double bucket);

}  // namespace navvy::vehicle
