// SPDX-License-Identifier: Apache-2.0
// Triangles of the shapes of links, and links as bodies, for beams.
#pragma once

#include <string>
#include <vector>

#include "core/math.h"
#include "geometry/ray_tree.h"
#include "geometry/triangle_mesh.h"
#include "heightfield/terrain.h"
#include "scene/scene.h"

namespace navvy::sensor {

/// Largest distance between a round shape and its triangles [m].
inline constexpr double kRoundness = 2e-4;

/// Returns the triangles of a shape in its own frame, with their fronts outwards. Round shapes get
/// as many triangles as kRoundness asks for.
/// @throws FileError or InputError for a mesh that cannot be read.
geometry::TriangleMesh mesh_of(const scene::Geometry& shape);

/// Appends the triangles of `part`, placed by X_AP, to `whole`, whose frame is A.
void append(const geometry::TriangleMesh& part, const Pose& X_AP, geometry::TriangleMesh& whole);

/// A link as beams meet it: its visuals, where it has none its collisions and shells.
struct SolidBody {
  int machine, link;             ///< indices of machine and link in the scene
  geometry::RayTree tree;        ///< triangles in the link's frame
  Vec3 middle, half;             ///< box around the triangles, in the link's frame [m]
  Pose X_LW = Pose::Identity();  ///< pose of W in the link's frame
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< box around the body in W [m]

  /// Moves the body to the pose `X_WL` of its link.
  void place(const Pose& X_WL);
  /// Returns true if a point is inside a closed body.
  bool contains(const Vec3& p_W) const;
};

/// Returns the links of all machines that beams can meet, in the order of machines and links, each
/// with its link's frame at W.
/// @throws FileError or InputError for a mesh that cannot be read.
std::vector<SolidBody> solid_bodies(const scene::Scene& scene);

/// The ground or the body that a point is inside of.
struct Enclosure {
  std::string what;  ///< the ground or a body, in words for messages; empty: the point is free
  int machine = -1;  ///< index of the body's machine in the scene; -1: no body
};

/// Returns what a point is inside of: the ground with this surface, or a closed body.
Enclosure around(const scene::Scene& scene, const heightfield::Terrain& surface,
                 const std::vector<SolidBody>& bodies, const Vec3& p_W);

}  // namespace navvy::sensor
