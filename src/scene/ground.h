// SPDX-License-Identifier: Apache-2.0
// The ground of a site: a heightmap file or procedural shapes, in layers of soil.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/math.h"

namespace navvy::scene {

/// One procedural shape added to the flat ground. Heights of `add` shapes are summed in file order,
/// then clipped to the datum (bedrock). Kinds use different members: what a kind does not use is
/// ignored. Lengths are along and across `yaw`, which turns from W's x towards its y.
struct GroundFeature {
  enum class Kind {
    kSlope,  ///< whole site: height grows by tan(angle) along `yaw`, zero at `center`
    kHills,  ///< whole site: seeded smooth noise, peak-to-valley `height`, wavelength `length`
    /// Cone of `height` standing at `angle` (0: the soil's friction angle) on `center`.
    kStockpile,
    /// Cut `depth`=height, `length` x `width`, sides at `angle` from vertical 0 = vertical.
    kTrench,
    /// Step of `height` across the line through `center` along `yaw`; rises to its left at `angle`
    /// face.
    kBank,
    kBlock  ///< free-standing block `length` x `width` x `height`, vertical faces
  };
  Kind kind = Kind::kSlope;
  Vec2 center = Vec2::Zero();  ///< [m] in W
  double yaw = 0;              ///< [rad]
  double length = 1;           ///< along yaw [m]
  double width = 1;            ///< across yaw [m]
  double height = 1;           ///< [m]; a trench's depth
  double angle = 0;            ///< [rad]
  std::uint64_t seed = 1;      ///< hills
};

/// A soil layer, listed from the surface down. The last one reaches to the bottom whatever its
/// thickness. Thickness counts downwards from the surface, whatever its shape.
struct GroundLayer {
  std::string soil;      ///< name in Scene::soils
  double thickness = 0;  ///< [m]
};

/// A rectangle where the layers differ from the site's. Later patches lie over earlier ones.
struct GroundPatch {
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< [m] in W
  std::vector<GroundLayer> layers;
};

/// Soil that starts as particles: the columns of a rectangle from a height up. For scenes and tests
/// that begin with soil in motion; elsewhere the exchange wakes soil when it is needed.
struct ActiveSoil {
  Vec2 min = Vec2::Zero(), max = Vec2::Zero();  ///< [m] in W
  double bottom = 0;                            ///< W height [m]
};

/// What to do with a heightmap's slopes that exceed the soil's repose. kHold leaves them as
/// surveyed; kSettle wears them down when the map is loaded.
enum class SteepGround { kHold, kSettle };

/// What a raster file without units and places of its own (NPY, PNG) leaves open.
struct RasterScale {
  double cell = 0;           ///< edge of a cell [m]; 0: the file's own (a PNG's world file)
  bool has_heights = false;  ///< `low` and `high` were given
  /// Heights that a PNG's least and greatest possible value stand for [m].
  double low = 0, high = 0;
  bool has_corner = false;  ///< `corner` was given
  /// Of the lower-left cell, in the coordinates that the site counts in.
  Vec2 corner = Vec2::Zero();
  bool north_first = false;  ///< an NPY's first row is its northern one; a PNG's always is
  bool any() const { return cell > 0 || has_heights || has_corner || north_first; }
};

/// The site's ground before anything has moved: what heightfield::Ground is built from.
struct StartGround {
  std::string file;     ///< GeoTIFF, ESRI ASCII, PNG or NPY; empty: procedural
  RasterScale scale;    ///< of `file`
  bool has_at = false;  ///< centre of the crop was given
  /// `at` counts from the file's lower-left corner, not in its own coordinates.
  bool at_is_local = false;
  Vec2 at = Vec2::Zero();  ///< [m]
  /// Extent of the site [m]; W's origin is the site's centre unless `origin` says otherwise.
  Vec2 size = Vec2(20, 20);
  Vec2 origin = Vec2(-10, -10);  ///< W coordinates of the site's lower-left corner [m]
  bool has_origin = false;       ///< false: origin = -size / 2
  double surface = 0;            ///< height of the flat ground of a procedural site [m]
  /// Soil below the lowest point of the surface; bedrock under it [m].
  double depth = 4;
  /// A level plane in the scene is the rock, and `depth` says nothing.
  bool has_rock = false;
  double rock = 0;  ///< its height in W [m]
  SteepGround steep = SteepGround::kHold;
  std::vector<GroundFeature> features;
  std::vector<GroundLayer> layers;  ///< at least one
  std::vector<GroundPatch> patches;
  std::vector<ActiveSoil> active;
};

}  // namespace navvy::scene
