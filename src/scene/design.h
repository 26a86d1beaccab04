// SPDX-License-Identifier: Apache-2.0
// What a site shall become: the design surface that planners and summaries hold the ground against.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/math.h"
#include "scene/ground.h"

namespace navvy::scene {

/// A triangulated surface in surveyors' coordinates, all in metres: easting, northing, elevation.
struct Tin {
  std::string file, name;                 ///< for messages
  int epsg = 0;                           ///< of its coordinate system; 0: not told
  double metres = 1;                      ///< a unit of the file; the points are converted
  std::vector<Vec3> points;               ///< [m]
  std::vector<std::array<int, 3>> faces;  ///< visible ones, indices of points, wound either way
};

/// A pit or a pad: a plane floor over a simple polygon, with battered sides outside it up or down
/// to the untouched ground. A place outside belongs to the nearest place of the polygon's edge, so
/// sides turn round outer corners as cones.
struct DesignArea {
  int line = 0;               ///< of the scene's file, for messages
  std::vector<Vec2> polygon;  ///< corners in W [m], closed by itself, wound either way
  /// Of the floor at the first corner below the untouched ground there [m]; < 0: a pad.
  double depth = 0;
  double fall = 0;              ///< angle by which the floor falls along `fall_yaw` [rad]
  double fall_yaw = 0;          ///< from W's x [rad]
  double batter = radians(90);  ///< of the sides from the horizontal [rad]; 90 deg: vertical
};

/// The design surface: from a file, or of areas that the scene lists. Where neither says anything
/// there is no design.
struct Design {
  std::string file;                ///< raster or LandXML; empty: areas, if any
  RasterScale scale;               ///< of a raster
  std::shared_ptr<const Tin> tin;  ///< read from `file` where that is LandXML
  std::vector<DesignArea> areas;   ///< later ones lie over earlier ones
  bool any() const { return !file.empty() || !areas.empty(); }
};

}  // namespace navvy::scene
