// SPDX-License-Identifier: Apache-2.0
// Design surface of a site, with which maps and summaries compare the ground.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/limits.h"
#include "scene/ground.h"

namespace navvy::scene {

/// A triangulated surface in survey coordinates: easting, northing and elevation in metres.
struct Tin {
  std::string file, name;                 ///< for messages
  int epsg = 0;                           ///< code of the coordinate system; 0: unknown
  double metres = 1;                      ///< length of the file's unit; the points are converted
  std::vector<Vec3> points;               ///< [m]
  std::vector<std::array<int, 3>> faces;  ///< visible ones, indices of points, wound either way
};

/// A pit or a pad: a plane floor over a simple polygon, with battered sides outside it up or down
/// to the untouched ground. A place outside belongs to the nearest place of the polygon's edge, so
/// sides turn round outer corners as cones.
struct DesignArea {
  int line = 0;                         ///< in the scene's file, for messages
  std::vector<Vec2> polygon;            ///< corners in W [m], closed by itself, wound either way
  double depth = 0;                     ///< [m]
  double fall = 0;                      ///< [rad]
  double fall_yaw = 0;                  ///< [rad]
  double batter = radians(90);          ///< [rad]
  std::vector<double> polygon_numbers;  ///< coordinates of `polygon` as read

  void describe(Fields& f) {
    f("polygon_m", polygon_numbers, {-1e6, 1e6},
      "Coordinates x y in W of 3 to 1000 corners; edges must not cross.", kNeeded);
    f("depth_m", depth, {-1000, 1000},
      "Depth of the floor at the first corner, below the untouched ground there; negative: a pad.",
      kNeeded);
    f("fall_deg", fall, {0, 60}, "Angle by which the floor falls.");
    f("fall_yaw_deg", fall_yaw, {-360, 360}, "Direction of the fall, from W's x.");
    f("batter_deg", batter, {5, 90}, "Angle of the sides from the horizontal; 90: vertical.");
  }
};

/// The design surface: a file or a list of areas. A scene without either has no design.
struct Design {
  std::string file;                ///< raster or LandXML
  RasterScale scale;               ///< of a raster
  std::shared_ptr<const Tin> tin;  ///< the surface of a LandXML `file`
  std::vector<DesignArea> areas;   ///< later ones override earlier ones
  std::string surface;

  bool any() const { return !file.empty() || !areas.empty(); }
  void describe(Fields& f) {
    f("file", file,
      "LandXML 1.2 TIN or a raster as for the ground, in the coordinates of the ground's map.",
      kShown);
    f("surface", surface, "Name of the surface in a LandXML file; by default the only one.",
      kShown);
    scale.describe(f);
    f("area", areas, limits::kDesignAreas, "Pit or pad; later ones override earlier ones.", kShown);
  }
};

}  // namespace navvy::scene
