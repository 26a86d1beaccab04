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

/// Triangulated surface (triangulated irregular network) in survey coordinates, in this order:
/// easting, northing and elevation [m].
struct Tin {
  /// Path of the LandXML file and name of the surface in that file, for messages.
  std::string file, name;
  int epsg = 0;  ///< EPSG code of the coordinate system; 0: unknown
  /// Length of the file's unit of length [m], for messages; `points` have already been converted to
  /// metres.
  double metres = 1;
  std::vector<Vec3> points;  ///< vertices: easting, northing, elevation [m]
  /// Visible triangles, each with three indices into `points`; either winding is allowed.
  std::vector<std::array<int, 3>> faces;
};

/// A pit or a pad: a plane floor inside a simple polygon. Outside the polygon, battered sides rise
/// or fall from its edge to the untouched ground. The height of a side at a point follows from the
/// nearest point of the polygon's edge, so the sides form cones around convex corners.
struct DesignArea {
  int line = 0;  ///< line of the area in the scene file, for messages
  /// Corners in W [m], in either winding; the last corner is connected to the first one.
  std::vector<Vec2> polygon;
  /// Depth of the floor at the first corner below the untouched ground there [m]; negative: a pad
  /// above the ground.
  double depth = 0;
  double fall = 0;      ///< slope angle of the floor [rad]; 0: level
  double fall_yaw = 0;  ///< direction in which the floor falls, measured from W's x axis [rad]
  double batter = radians(90);  ///< angle of the sides from the horizontal [rad]; pi/2: vertical
  /// Coordinates of `polygon` as the file lists them: x y x y ...
  std::vector<double> polygon_numbers;

  /// Passes the fields of an <area> to the visitor `f`.
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

/// The design surface of a scene: a file or a list of areas, never both. A scene without either has
/// no design.
struct Design {
  std::string file;   ///< path of a raster or LandXML file; empty: none
  int file_line = 0;  ///< line in the scene file that names it; 0: none does
  RasterScale scale;  ///< cell size, heights and corner of a raster without its own georeference
  /// Surface read from a LandXML `file`; null for a raster or without a file.
  std::shared_ptr<const Tin> tin;
  std::vector<DesignArea> areas;  ///< pits and pads; where areas overlap, the last one is valid
  std::string surface;  ///< name of the surface in a LandXML file; empty: the only one in the file

  /// Returns true if the scene has a design.
  bool any() const { return !file.empty() || !areas.empty(); }
  /// Passes the fields of <navvy:design> to the visitor `f`.
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
