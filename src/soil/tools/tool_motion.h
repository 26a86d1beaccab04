// SPDX-License-Identifier: Apache-2.0
// Interface between the soil and the machines that move its tools: poses and twists in, impulses
// out. Vectors have the axes of W; units are SI.
#pragma once

#include "core/math.h"

namespace navvy::soil {

/// Motion of a tool during the coming step. T is the link frame of the tool's shell.
struct ToolMotion {
  /// Tool index that Solver::add_tool returned.
  int tool = -1;
  /// Pose of T in W at the start of the step.
  Pose X_WT = Pose::Identity();
  /// Velocity of T's origin before the soil acts [m/s].
  Vec3 v_WT = Vec3::Zero();
  /// Angular velocity before the soil acts [rad/s].
  Vec3 w_WT = Vec3::Zero();
  /// Inverse of the link's effective (articulated) mass: the change of (angular velocity, velocity
  /// of T's origin) per unit of (angular impulse about T's origin, impulse). Zero for a scripted
  /// tool, whose motion the soil does not change.
  Mat6 inverse_mass = Mat6::Zero();
};

/// A tool and its pose.
struct PlacedTool {
  /// Tool index that Solver::add_tool returned.
  int tool = -1;
  /// Pose of T in W.
  Pose X_WT = Pose::Identity();
};

/// Impulse of the soil on a tool during one step.
struct ToolImpulse {
  /// Impulse on the tool [N s].
  Vec3 J_W = Vec3::Zero();
  /// Angular impulse on the tool about p_W [N m s].
  Vec3 L_W = Vec3::Zero();
  /// Origin of T in W at the start of the step [m].
  Vec3 p_W = Vec3::Zero();
  /// Mean force [N] and mean moment about T's origin [N m] over the last completed transfer, for
  /// display and sensors. The impulses of single steps vary like a saw-tooth within a transfer
  /// [docs/tools.md, force].
  Vec3 force_W = Vec3::Zero(), moment_W = Vec3::Zero();
  /// Parts of J_W and L_W that act on the edges of plates; the rest acts on faces.
  Vec3 J_edge_W = Vec3::Zero(), L_edge_W = Vec3::Zero();
  /// Part of force_W that acts on the edges of plates [N].
  Vec3 edge_force_W = Vec3::Zero();
  /// Sum of the magnitudes of the normal impulses at all nodes [N s].
  double normal = 0;
  /// Sum of the magnitudes of the tangential impulses at all nodes [N s].
  double friction = 0;
  /// Momentum check of the contact at the nodes, zero up to rounding: `residual` = J_W + momentum
  /// change of the nodes [N s]; `residual_moment` = L_W + change of their angular momentum about
  /// p_W [N m s].
  Vec3 residual = Vec3::Zero(), residual_moment = Vec3::Zero();
  /// Sums of magnitudes over all nodes, to which the residuals are compared: `scale` of impulses
  /// [N s], `scale_moment` of angular impulses [N m s].
  double scale = 0, scale_moment = 0;
};

/// Region that a tool occupies, as input to the exchange: soil ahead of the region becomes active,
/// and soil near it stays active.
struct ToolRegion {
  /// Tool index that Solver::add_tool returned.
  int tool = -1;
  /// True if a resting contact supports the tool; the tool then keeps no soil active.
  bool supported = false;
  /// Lowest and highest corner of the axis-aligned bounding box of the shell in W [m].
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  /// Velocity of the centre of the box [m/s].
  Vec3 velocity = Vec3::Zero();
};

}  // namespace navvy::soil
