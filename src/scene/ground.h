// SPDX-License-Identifier: Apache-2.0
// The ground of a site: a heightmap file or procedural shapes, in layers of soil.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

inline constexpr Range kPlaceRange = {-1e6, 1e6};   ///< of a place in W [m]
inline constexpr Range kLengthRange = {0.01, 1e5};  ///< of a length on the site [m]

/// One procedural shape on the flat ground. The heights of all shapes are added in the order of the
/// file, and the sum is clipped at the bedrock. Each type uses only the members that `describe`
/// visits for it. `length` is measured along `yaw`, `width` across it.
struct GroundFeature {
  enum class Kind { kSlope, kHills, kStockpile, kTrench, kBank, kBlock };
  Kind kind = Kind::kSlope;
  /// Reference point in W [m].
  Vec2 center = Vec2::Zero();
  /// Direction, counter-clockwise from W's x axis [rad].
  double yaw = 0;
  /// Extent along `yaw` [m]; the wavelength of hills.
  double length = 1;
  /// Extent across `yaw` [m].
  double width = 1;
  /// Height over the flat ground [m]; the depth of a trench.
  double height = 1;
  /// Slope angle [rad]; `describe` explains it for each type.
  double angle = 0;
  std::uint64_t seed = 1;
  /// True if the file gives `seed`; otherwise it is the scene's seed.
  bool has_seed = false;

  /// Returns a shape with the default values of its type.
  static GroundFeature of(Kind kind) {
    GroundFeature shape;
    shape.kind = kind;
    if (kind == Kind::kHills) shape.length = 20;
    if (kind == Kind::kBank) shape.angle = radians(90);
    return shape;
  }
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

/// A layer of soil. The thickness is measured vertically from the layer's upper surface.
struct GroundLayer {
  std::string soil;
  /// Thickness [m]; 0 for the last layer, which reaches to the rock.
  double thickness = 0;

  void describe(Fields& f) {
    f("soil", soil, Refers::kSoil, "Soil of the layer.", kNeeded);
    f("thickness_m", thickness, {1e-3, 1e4},
      "Thickness; the last layer leaves it out and reaches to the rock.");
  }
};

/// A rectangle with layers of its own. Where patches overlap, the last one counts.
struct GroundPatch {
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< [m] in W
  std::vector<GroundLayer> layers;

  void describe(Fields& f) {
    f("min_m", min, kPlaceRange, "Corner in W of least x and y.", kNeeded);
    f("max_m", max, kPlaceRange, "Corner in W of greatest x and y.", kNeeded);
    f("layer", layers, limits::kGroundLayers, "Layers of soil from the surface down.", kNeeded);
  }
};

/// A rectangle in which soil above a height is active (simulated as particles) from the start.
/// Elsewhere soil becomes active when a tool approaches.
struct ActiveSoil {
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< [m] in W
  /// Height in W above which the soil is active [m].
  double bottom = 0;

  void describe(Fields& f) {
    f("min_m", min, kPlaceRange, "Corner in W of least x and y.", kNeeded);
    f("max_m", max, kPlaceRange, "Corner in W of greatest x and y.", kNeeded);
    f("bottom_m", bottom, {-1e4, 1e4}, "Height in W above which the soil starts as particles.");
  }
};

/// Treatment of heightmap slopes that exceed the soil's angle of repose: kHold keeps them as
/// surveyed, kSettle lowers them when the map is loaded.
enum class SteepGround { kHold, kSettle };

/// Units and coordinates of a raster file that does not contain them (NPY, PNG).
struct RasterScale {
  /// Edge of a raster cell [m]; 0: as in the file (a PNG's world file).
  double cell = 0;
  /// True if `low` and `high` were given.
  bool has_heights = false;
  /// Heights of a PNG's minimum and maximum pixel value [m].
  double low = 0, high = 0;
  /// True if `corner` was given.
  bool has_corner = false;
  /// Coordinates of the raster's lower-left corner, in the coordinate system of the site's map [m].
  Vec2 corner = Vec2::Zero();
  /// True if an NPY's first row is the northernmost one. A PNG's first row always is.
  bool north_first = false;
  /// `low` and `high` as one vector, as the file gives them.
  Vec2 heights = Vec2::Zero();

  /// Copies `heights` into `low` and `high`.
  void take_heights() { low = heights.x(), high = heights.y(); }
  bool any() const { return cell > 0 || has_heights || has_corner || north_first; }
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

/// Ground of the site before anything has moved. The simulation builds its layered ground from it.
struct StartGround {
  /// Path of the heightmap; empty for procedural ground.
  std::string file;
  /// Units and coordinates of `file`, if it has none of its own.
  RasterScale scale;
  /// True if `at` was given; otherwise the site is in the middle of the map.
  bool has_at = false;
  /// True if `at` counts from the map's lower-left corner, not in map coordinates.
  bool at_is_local = false;
  /// Position of the site's centre on the map [m].
  Vec2 at = Vec2::Zero();
  Vec2 size = Vec2(20, 20);
  Vec2 origin = Vec2(-10, -10);
  /// True if `origin` was given; otherwise it is -size / 2.
  bool has_origin = false;
  double surface = 0;
  double depth = 4;
  /// True if a level plane in the scene defines the bedrock; `depth` is then unused.
  bool has_rock = false;
  /// Height of the bedrock plane in W [m], if `has_rock`.
  double rock = 0;
  SteepGround steep = SteepGround::kHold;
  std::vector<GroundFeature> features;
  /// Layers of the site from the surface down, at least one.
  std::vector<GroundLayer> layers;
  std::vector<GroundPatch> patches;
  std::vector<ActiveSoil> active;

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
