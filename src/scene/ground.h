// SPDX-License-Identifier: Apache-2.0
// The ground of a site at the start of a run: a heightmap file or procedural shapes, with layers of
// soil.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Allowed coordinates of a point in W [m].
inline constexpr Range kPlaceRange = {-1e6, 1e6};
/// Allowed values of a length on the site [m].
inline constexpr Range kLengthRange = {0.01, 1e5};

/// One procedural shape that is added to the flat ground. The heights of all shapes are added in
/// the order of the file, and the sum is limited to heights above the bedrock. A type of shape uses
/// only those members that `describe` lists for it. `length` is measured along the direction `yaw`,
/// which turns from W's x axis towards its y axis, and `width` across it.
struct GroundFeature {
  /// Type of the shape.
  enum class Kind { kSlope, kHills, kStockpile, kTrench, kBank, kBlock };
  Kind kind = Kind::kSlope;    ///< type of the shape
  Vec2 center = Vec2::Zero();  ///< position of the shape's middle in W [m]
  double yaw = 0;              ///< direction of the shape, from W's x axis [rad]
  double length = 1;  ///< extent along `yaw` [m]; for hills the typical distance from hill to hill
  double width = 1;   ///< extent across `yaw` [m]
  double height = 1;  ///< height above the ground [m]; for a trench the depth below the ground
  /// Angle of a slope, of the sides or of a face [rad]: from the vertical for a trench, otherwise
  /// from the horizontal.
  double angle = 0;
  std::uint64_t seed = 1;  ///< seed of the hills' noise
  bool has_seed = false;   ///< false: `seed` was not given, so the hills use the scene's seed

  /// Returns a shape of type `kind` with the default values of that type.
  static GroundFeature of(Kind kind) {
    GroundFeature shape;
    shape.kind = kind;
    if (kind == Kind::kHills) shape.length = 20;
    if (kind == Kind::kBank) shape.angle = radians(90);
    return shape;
  }
  /// Passes the fields of a shape of this type to the visitor `f`.
  void describe(Fields& f) {
    const bool box = kind == Kind::kTrench || kind == Kind::kBlock;
    f.derived_kind("kind", kind);
    if (kind != Kind::kHills)
      f("center_m", center, kPlaceRange, "Place in W of the middle, or of unchanged height.");
    if (kind != Kind::kHills && kind != Kind::kStockpile)
      f("yaw_deg", yaw, {-360, 360},
        "Direction from W's x: of a slope the way up, of a bank its edge, else of the length.");
    if (box) f("length_m", length, kLengthRange, "Extent along the direction.", kNeeded);
    if (box) f("width_m", width, kLengthRange, "Extent across the direction.", kNeeded);
    if (kind == Kind::kTrench)
      f("depth_m", height, {0.01, 1000}, "Depth below the ground.", kNeeded);
    else if (kind != Kind::kSlope)
      f("height_m", height, {0.01, 1000}, "Height over the ground; of hills from peak to valley.",
        kNeeded);
    if (kind == Kind::kHills) {
      f("wavelength_m", length, {0.1, 1e5}, "Typical distance from hill to hill.");
      f("seed", seed, "Seed of the noise; by default the seed of the scene.",
        kShown | given(has_seed));
      f.derived("seed", seed);
    }
    // Below 60 degrees the tangent stays small enough for a site of kilometres.
    if (kind == Kind::kSlope)
      f("angle_deg", angle, {-60, 60}, "Angle of the slope from the horizontal.", kNeeded);
    if (kind == Kind::kStockpile)
      f("angle_deg", angle, {0, 80}, "Angle of the sides; 0: the soil's angle of repose.");
    if (kind == Kind::kTrench)
      f("angle_deg", angle, {0, 80}, "Angle of the sides from the vertical.");
    if (kind == Kind::kBank) f("angle_deg", angle, {1, 90}, "Angle of the face; 90: vertical.");
  }
};

/// A layer of soil. Layers are stacked from the surface downwards and follow the shape of the
/// ground.
struct GroundLayer {
  std::string soil;  ///< name of the layer's soil
  /// Thickness of the layer [m]; ignored for the last layer, which reaches to the rock.
  double thickness = 0;

  /// Passes the fields of a <layer> to the visitor `f`.
  void describe(Fields& f) {
    f("soil", soil, Refers::kSoil, "Soil of the layer.", kNeeded);
    f("thickness_m", thickness, {1e-3, 1e4},
      "Thickness; the last layer leaves it out and reaches to the rock.");
  }
};

/// An axis-aligned rectangle in which other layers replace those of the site. Where patches
/// overlap, the last one is valid.
struct GroundPatch {
  /// Corners with the lowest and the highest x and y in W [m].
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();
  std::vector<GroundLayer> layers;  ///< layers inside the rectangle, from the surface downwards

  /// Passes the fields of a <patch> to the visitor `f`.
  void describe(Fields& f) {
    f("min_m", min, kPlaceRange, "Corner in W of least x and y.", kNeeded);
    f("max_m", max, kPlaceRange, "Corner in W of greatest x and y.", kNeeded);
    f("layer", layers, limits::kGroundLayers, "Layers of soil from the surface down.", kNeeded);
  }
};

/// A part of the ground that consists of particles from the start: the soil inside a rectangle and
/// above a height. It is used in scenes and tests that begin with moving soil; in other scenes
/// tools activate the soil.
struct ActiveSoil {
  /// Corners with the lowest and the highest x and y in W [m].
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();
  double bottom = 0;  ///< height in W above which the soil is active [m]

  /// Passes the fields of an <active> to the visitor `f`.
  void describe(Fields& f) {
    f("min_m", min, kPlaceRange, "Corner in W of least x and y.", kNeeded);
    f("max_m", max, kPlaceRange, "Corner in W of greatest x and y.", kNeeded);
    f("bottom_m", bottom, {-1e4, 1e4}, "Height in W above which the soil starts as particles.");
  }
};

/// Treatment of slopes in a heightmap that are steeper than the soil's angle of repose: kHold
/// leaves them unchanged, kSettle flattens them when the map is loaded.
enum class SteepGround { kHold, kSettle };

/// Scale and position of a raster file that does not contain them, such as NPY and PNG.
struct RasterScale {
  double cell = 0;  ///< edge of a raster cell [m]; 0: as in the file (or a PNG's world file)
  bool has_heights = false;  ///< true: `low` and `high` were given
  double low = 0, high = 0;  ///< heights of a PNG's lowest and highest pixel values [m]
  bool has_corner = false;   ///< true: `corner` was given
  /// Lower-left corner of the raster in the coordinates of the map [m].
  Vec2 corner = Vec2::Zero();
  /// True: the first row of an NPY file is the northernmost one. The first row of a PNG always is.
  bool north_first = false;
  Vec2 heights = Vec2::Zero();  ///< `low` and `high` as the file gives them

  /// Copies the two elements of `heights` into `low` and `high`.
  void take_heights() { low = heights.x(), high = heights.y(); }
  /// Returns true if any member has been given a value.
  bool any() const { return cell > 0 || has_heights || has_corner || north_first; }
  /// Passes the fields for the scale and position of a raster to the visitor `f`.
  void describe(Fields& f) {
    f("map_cell_m", cell, {0.001, 1e4},
      "Edge of a cell of a PNG or NPY; needed unless a PNG has a world file beside it.", kShown);
    f("map_heights_m", heights, {-12000, 12000},
      "Heights of a PNG's least and greatest value (0 and 65535, or 255); an NPY holds metres.",
      kShown | given(has_heights));
    f("map_corner_m", corner, {-1e9, 1e9}, "Coordinates of the lower-left corner of a PNG or NPY.",
      kShown | given(has_corner));
    f("map_rows", north_first, {{"south_first", false}, {"north_first", true}},
      "Order of the rows of an NPY.", kShown);
  }
};

/// The site's ground at the start of a run, from which heightfield::Ground is built.
struct StartGround {
  std::string file;              ///< path of a heightmap; empty: flat ground plus `features`
  int file_line = 0;             ///< line in the scene file that names the heightmap; 0: none does
  RasterScale scale;             ///< scale and position of a heightmap without its own georeference
  bool has_at = false;           ///< true: the centre of the site in the map was given
  bool at_is_local = false;      ///< true: `at` is relative to the file's lower-left corner
  Vec2 at = Vec2::Zero();        ///< centre of the site in the coordinates of the map [m]
  Vec2 size = Vec2(20, 20);      ///< extent of the site along x and y [m]
  Vec2 origin = Vec2(-10, -10);  ///< coordinates in W of the site's lower-left corner [m]
  bool has_origin = false;       ///< true: `origin` was given; false: it is -size / 2
  double surface = 0;            ///< height in W of the flat ground [m]
  /// Thickness of the soil between the rock and the lowest point of the surface [m].
  double depth = 4;
  /// True: a level plane in the scene is the rock surface, and `depth` is ignored.
  bool has_rock = false;
  double rock = 0;  ///< height in W of the rock plane [m], if `has_rock`
  /// Treatment of slopes in a heightmap that are too steep for the soil.
  SteepGround steep = SteepGround::kHold;
  std::vector<GroundFeature> features;  ///< procedural shapes, in the order of the file
  std::vector<GroundLayer> layers;      ///< layers of soil from the surface downwards, at least one
  std::vector<GroundPatch> patches;     ///< rectangles with other layers
  std::vector<ActiveSoil> active;       ///< soil that is active at the start

  /// Passes the fields of <navvy:ground> to the visitor `f`.
  void describe(Fields& f) {
    f("file", file,
      "Heightmap: GeoTIFF, ESRI ASCII, 16-bit PNG or NPY, from the folder of the scene file. "
      "Without it the ground is flat plus shapes.",
      kShown);
    f.derived_text("is_map", [this] { return file.empty() ? "no" : "yes"; });
    scale.describe(f);
    f("at_m", at, {-1e9, 1e9},
      "Centre of the site in the map's own coordinates; by default the map's centre.",
      given(has_at));
    f("at_local_m", at, {-1e9, 1e9}, "Centre of the site, from the map's lower-left corner.",
      given(at_is_local));
    f("size_m", size, {0.5, 1e5}, "Extent of the site, 4 to 65536 cells on each edge.");
    f("origin_m", origin, kPlaceRange,
      "Coordinates in W of the site's lower-left corner; by default -size/2.", given(has_origin));
    f("surface_m", surface, {-1e4, 1e4}, "Height in W of the flat ground.");
    f("depth_m", depth, {0.1, 1000},
      "Thickness of soil below the lowest point of the surface; there is rock under it.");
    f.derived("has_rock", has_rock);
    f.derived("rock", rock);
    f("steep", steep, {{"hold", SteepGround::kHold}, {"settle", SteepGround::kSettle}},
      "Treatment of slopes of a map that are steeper than the soil stands.");
    f("layer", layers, limits::kGroundLayers,
      "Layers of soil from the surface down; a world of one soil needs none.");
    f("patch", patches, limits::kGroundParts, "Other layers in a rectangle; later ones win.");
    f("active", active, limits::kGroundParts, "Soil in a rectangle that starts as particles.");
    using Kind = GroundFeature::Kind;
    f.list("shape", features, limits::kGroundParts,
           std::vector<Start<GroundFeature>>{
               {"slope", "Plane slope of the whole site.", GroundFeature::of(Kind::kSlope)},
               {"hills", "Smooth noise over the whole site.", GroundFeature::of(Kind::kHills)},
               {"stockpile", "Cone of soil.", GroundFeature::of(Kind::kStockpile)},
               {"trench", "Cut of rectangular plan.", GroundFeature::of(Kind::kTrench)},
               {"bank", "Step whose left side is higher.", GroundFeature::of(Kind::kBank)},
               {"block", "Block with vertical faces.", GroundFeature::of(Kind::kBlock)}});
  }
};

}  // namespace navvy::scene
