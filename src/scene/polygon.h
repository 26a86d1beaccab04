// SPDX-License-Identifier: Apache-2.0
// Simple polygons in scene files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::scene {

/// Fault of the coordinates of a polygon.
struct PolygonFault {
  std::string value;   ///< offending value
  std::string rule;    ///< violated rule
  std::string remedy;  ///< how to correct it
};

/// Converts coordinates x y x y ... [m] to the corners of a polygon. Returns a fault unless these
/// make a simple polygon of 3 to limits::kDesignCorners corners; with too few or too many numbers
/// `corners` stays empty.
std::optional<PolygonFault> polygon_of(const std::vector<double>& numbers,
                                       std::vector<Vec2>& corners);

/// Returns true if the point `p` is inside a polygon (even-odd rule).
bool contains(const std::vector<Vec2>& polygon, const Vec2& p);

/// Returns the longest edge of a polygon, from its beginning to its end [m]; of equal ones the
/// first.
Vec2 longest_edge(const std::vector<Vec2>& polygon);

}  // namespace navvy::scene
