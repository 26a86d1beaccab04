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

/// Triangulated irregular network (TIN) in survey coordinates: easting, northing and elevation in
/// metres.
struct Tin {
  std::string file, name;  ///< for messages
  /// EPSG code of the coordinate reference system; 0 if unknown.
  int epsg = 0;
  /// Length of the file's unit in metres. `points` have been converted already.
  double metres = 1;
  std::vector<Vec3> points;  ///< [m]
  /// Visible triangles, as indices into `points`. The winding is arbitrary.
  std::vector<std::array<int, 3>> faces;
};

/// A pit or a pad: a plane floor over a simple polygon, with battered sides that rise (pit) or fall
/// (pad) outside the polygon until they meet the original ground. At an outside corner the side is
/// a cone around the corner.
struct DesignArea {
  /// Line of the <area> in the scene file, for messages.
  int line = 0;
  /// Corners in W [m], in either direction; the last corner connects to the first.
  std::vector<Vec2> polygon;
  /// Floor depth at the first corner [m]; negative for a pad.
  double depth = 0;
  /// Slope angle of the floor [rad].
  double fall = 0;
  /// Direction in which the floor falls, counter-clockwise from W's x axis [rad].
  double fall_yaw = 0;
  /// Angle between the sides and the horizontal [rad].
  double batter = radians(90);
  /// The coordinates x y x y ... of `polygon` as read; empty afterwards.
  std::vector<double> polygon_numbers;

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

/// Design surface of a site: either a file or a list of areas. A scene without either has no
/// design.
struct Design {
  std::string file;  ///< raster or LandXML
  /// Scale of a raster file that has none of its own.
  RasterScale scale;
  /// The surface read from a LandXML `file`; null otherwise.
  std::shared_ptr<const Tin> tin;
  /// Pits and pads; later ones override earlier ones where they overlap.
  std::vector<DesignArea> areas;
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
