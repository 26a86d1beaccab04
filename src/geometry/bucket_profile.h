// SPDX-License-Identifier: Apache-2.0
// Finds the side profile of a digging bucket in a mesh that was made for pictures.
#pragma once

#include <optional>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Side profile of a bucket in a frame with its origin at the bucket's pin and y along the axis
/// about which it turns. x and z may point anywhere across that axis; `navvy import` has x forward,
/// y left and z up, as the machine's.
struct BucketProfile {
  /// Points (x, z) from the cutting edge along floor and back to the upper edge of the back [m].
  std::vector<Vec2> points;
  double y_low = 0, y_high = 0;  ///< extent along the axis [m]
};

/// Returns the outer side profile of a bucket: the convex hull of the mesh's section half-way
/// between its sides, without its mouth, which is the longest edge of the hull that runs through
/// empty space. The cutting edge is the end of the mouth that is further from the pin. Returns
/// nothing for a mesh without such a mouth, for example a block. The profile has at most a few tens
/// of points, within 1 % of its size.
std::optional<BucketProfile> find_bucket_profile(const TriangleMesh& mesh);

/// Returns a shell with this profile and two flat side plates, wound so that the fronts are the
/// inside.
TriangleMesh shell_of(const BucketProfile& profile);

/// Returns what a bucket with this profile holds with a heap of slopes of 1:1 on its mouth [m3].
double heaped_capacity(const BucketProfile& profile);

/// Returns the unit vector (x, z) along the floor at the cutting edge, outward.
Vec2 cut_direction(const BucketProfile& profile);

/// Returns the unit vector (x, z) square to the mouth, out of the bucket.
Vec2 opening(const BucketProfile& profile);

}  // namespace navvy::geometry
