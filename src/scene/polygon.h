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

}  // namespace navvy::scene
