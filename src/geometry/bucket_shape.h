// SPDX-License-Identifier: Apache-2.0
// Shape of a digging bucket of plates that follows from a few numbers of a data sheet.
#pragma once

#include <array>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace navvy::geometry {

/// Numbers of a bucket as a data sheet gives them. The bucket's frame B has its origin at the pin,
/// x towards the middle of the cutting edge, z into the bucket, away from the mouth, and y to the
/// left.
struct BucketSize {
  double width = 1;       ///< width of the cut, over the outer faces of the side plates [m]
  double tip_radius = 1;  ///< distance from the pin to the cutting edge [m]
  double plate = 0.03;    ///< thickness of all plates [m]
  /// The bucket is narrower than its cut by this much on either side at its back [m].
  double clearance = 0;
};

/// Teeth as drawn, side by side on the cutting edge.
struct DrawnTeeth {
  int number = 0;     ///< number of teeth
  double width = 0;   ///< width of each [m]
  double length = 0;  ///< length ahead of the cutting edge [m]
};

/// Returns the smallest and the greatest heaped capacity [m3] that a bucket of this size can have:
/// the depth of its side profile is between 0.5 and 1.6 times that of the shipped excavators. Both
/// are zero if the plates leave no space between them.
std::array<double, 2> heaped_capacities(const BucketSize& size);

/// Returns the factor on the depth of the side profile with which the bucket holds `capacity` [m3],
/// heaped; `capacity` must be within `heaped_capacities`.
double depth_for(const BucketSize& size, double capacity);

/// Returns the space between the plates and below the mouth, which reaches from the cutting edge to
/// the upper edge of the back, plus a heap on it with slopes of 1:1 [SAE J296] [m3]. `depth` is the
/// factor of `depth_for`.
double heaped_capacity(const BucketSize& size, double depth);

/// Returns the volume [m3] of a heap with slopes of 1:1 on a flat mouth from u0 to u1 [m], whose
/// half width at u is `half` [m] - `slope` [-] times u. The height of the heap is the distance from
/// the nearest edge of the mouth. The relative error is below 1e-6 for mouths up to 20 times as
/// long as their half width.
double heap_volume(double u0, double u1, double half, double slope);

/// Returns the middle surface of the plates in B, wound so that the fronts are the inside: back,
/// floor and two flat side plates, with the mouth open.
TriangleMesh bucket_shell(const BucketSize& size, double depth);

/// Returns a shell of back, floor and two flat side plates. `left` and `right` are the profiles of
/// its sides from the cutting edge to the upper edge of the back, equally many points, and the
/// `middles` those of the mouth at the left and right side, from which the triangles of the side
/// plates spread. Fronts are the inside for profiles that run as that of a bucket in B, otherwise
/// the outside.
TriangleMesh plate_shell(const std::vector<Vec3>& left, const std::vector<Vec3>& right,
                         const std::array<Vec3, 2>& middles);

/// Returns the direction of the floor at the cutting edge in B, outward, as a unit vector.
Vec3 cut_direction(const BucketSize& size, double depth);

/// Returns closed bodies to draw in B: plates, the bar of the cutting edge, teeth, and two ears
/// around the pin and the `pins`, places (x, z) in B of further pins. The triangles of edge and
/// teeth have material 0, worn steel; the others have none.
TriangleMesh bucket_picture(const BucketSize& size, double depth, const DrawnTeeth& teeth,
                            const std::vector<Vec2>& pins);

}  // namespace navvy::geometry
