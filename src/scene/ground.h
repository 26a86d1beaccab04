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

/// One procedural shape added to the flat ground. Heights are summed in the order of the file, then
/// clipped to the bedrock. A kind uses the members that `describe` lists for it. Lengths are along
/// and across `yaw`, which turns from W's x towards its y.
struct GroundFeature {
  enum class Kind { kSlope, kHills, kStockpile, kTrench, kBank, kBlock };
  Kind kind = Kind::kSlope;
  Vec2 center = Vec2::Zero();  ///< [m] in W
  double yaw = 0;              ///< [rad]
  double length = 1;           ///< [m]; of hills the wavelength
  double width = 1;            ///< [m]
  double height = 1;           ///< [m]; of a trench its depth
  double angle = 0;            ///< [rad]
  std::uint64_t seed = 1;
  bool has_seed = false;  ///< false: the scene's seed

  /// Returns a shape with the default values of its kind.
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

/// A layer of soil; its thickness counts from the surface down, whatever the shape of the ground.
struct GroundLayer {
  std::string soil;
  double thickness = 0;  ///< [m]

  void describe(Fields& f) {
    f("soil", soil, Refers::kSoil, "Soil of the layer.", kNeeded);
    f("thickness_m", thickness, {1e-3, 1e4},
      "Thickness; the last layer leaves it out and reaches to the rock.");
  }
};

/// A rectangle where the layers differ from the site's. Later patches override earlier ones.
struct GroundPatch {
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< [m] in W
  std::vector<GroundLayer> layers;

  void describe(Fields& f) {
    f("min_m", min, kPlaceRange, "Corner in W of least x and y.", kNeeded);
    f("max_m", max, kPlaceRange, "Corner in W of greatest x and y.", kNeeded);
    f("layer", layers, limits::kGroundLayers, "Layers of soil from the surface down.", kNeeded);
  }
};

/// Soil that is active at the start: the columns of a rectangle from a height up. For scenes and
/// tests that begin with soil in motion; elsewhere tools activate soil.
struct ActiveSoil {
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< [m] in W
  double bottom = 0;                            ///< height in W [m]

  void describe(Fields& f) {
    f("min_m", min, kPlaceRange, "Corner in W of least x and y.", kNeeded);
    f("max_m", max, kPlaceRange, "Corner in W of greatest x and y.", kNeeded);
    f("bottom_m", bottom, {-1e4, 1e4}, "Height in W above which the soil starts as particles.");
  }
};

/// Treatment of slopes of a heightmap beyond the soil's repose: kHold keeps them as surveyed,
/// kSettle lowers them when the map is loaded.
enum class SteepGround { kHold, kSettle };

/// Values that a raster without units and coordinates of its own (NPY, PNG) does not hold.
struct RasterScale {
  double cell = 0;              ///< [m]; 0: the file's own (a PNG's world file)
  bool has_heights = false;     ///< `low` and `high` were given
  double low = 0, high = 0;     ///< [m]
  bool has_corner = false;      ///< `corner` was given
  Vec2 corner = Vec2::Zero();   ///< in the coordinates of the site [m]
  bool north_first = false;     ///< an NPY's first row is the northern one; a PNG's always is
  Vec2 heights = Vec2::Zero();  ///< `low` and `high` as read

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

/// The site's ground before anything has moved, from which heightfield::Ground is built.
struct StartGround {
  std::string file;  ///< empty: procedural
  RasterScale scale;
  bool has_at = false;       ///< the centre of the crop was given
  bool at_is_local = false;  ///< `at` counts from the file's lower-left corner
  Vec2 at = Vec2::Zero();    ///< [m]
  Vec2 size = Vec2(20, 20);
  Vec2 origin = Vec2(-10, -10);
  bool has_origin = false;  ///< false: origin = -size / 2
  double surface = 0;
  double depth = 4;
  bool has_rock = false;  ///< a level plane in the scene is the rock; `depth` does not count
  double rock = 0;        ///< its height in W [m]
  SteepGround steep = SteepGround::kHold;
  std::vector<GroundFeature> features;
  std::vector<GroundLayer> layers;  ///< at least one
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
