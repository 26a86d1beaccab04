// SPDX-License-Identifier: Apache-2.0
// Areas that rigid bodies occupy on a site: plain data for maps, which know no bodies.
#pragma once

#include <memory>
#include <vector>

#include "core/math.h"

namespace navvy::heightfield {

/// The outline of a rigid body, or of a part of one, seen from above.
struct OccupiedArea {
  /// Corners of the convex outline in W [m], counter-clockwise.
  std::vector<Vec2> outline;
  /// Lowest and highest point of the body, as world z [m].
  double low = 0, high = 0;
  /// True for a part of a machine; false for a body without joints, wheels and program.
  bool machine = false;
};

/// Areas of several bodies, shared by the views that contain them; may be null.
using OccupiedAreas = std::shared_ptr<const std::vector<OccupiedArea>>;

/// Returns the area of a body with the given points in W [m]: their convex hull seen from above.
OccupiedArea area_around(const std::vector<Vec3>& points, bool machine);
/// Returns true if the outline and the axis-aligned rectangle from `low` to `high` [m] have a point
/// in common.
bool meets(const OccupiedArea& area, const Vec2& low, const Vec2& high);

}  // namespace navvy::heightfield
