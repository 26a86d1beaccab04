// SPDX-License-Identifier: Apache-2.0
// Formats a rectangle of coordinates for messages.
#pragma once

#include <cstdio>
#include <string>

#include "core/math.h"

namespace navvy::heightfield {

/// Returns the rectangle from `low` to `high` as text, such as "x 0.000 .. 12.500, y -3.000 ..
/// 4.000".
inline std::string span_text(const Vec2& low, const Vec2& high) {
  // Space for four numbers as long as a double may be.
  char text[1400];
  std::snprintf(text, sizeof text, "x %.3f .. %.3f, y %.3f .. %.3f", low.x(), high.x(), low.y(),
                high.y());
  return text;
}

}  // namespace navvy::heightfield
