// SPDX-License-Identifier: Apache-2.0
// The layers of a terrain map: one table with the name, the unit and the rule of each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace navvy::map {

class ColumnBlock;
class Surround;

/// A layer of a map: one float32 per column of the site, NaN where the value is unknown.
/// src/map/README.md gives the formulas. To add a layer, add an enumerator here and a row in
/// map_layers.cpp.
enum class MapLayer : std::uint8_t {
  /// Surface in W [m].
  kElevation,
  /// Surface of the untouched site in W [m].
  kElevationStart,
  /// Design surface in W [m]; unknown where the scene has no design.
  kTarget,
  /// Elevation minus target [m]; positive where soil is still to be removed.
  kCutFill,
  /// Angle of the surface from the horizontal [rad].
  kSlope,
  /// Largest height between neighbouring columns within the window [m].
  kStepHeight,
  /// Rms distance from the least-squares plane through the window [m].
  kRoughness,
  /// 0 (not drivable) to 1 (best).
  kTraversability,
  /// Depth of the soil that rests on the columns as particles [m].
  kLooseDepth,
  /// Bulk density of the uppermost soil in its present state [kg/m3].
  kDensity,
  /// Index of the uppermost soil in the scene's list.
  kSoil,
  /// Simulated time of the last observed change [s]; unknown where none was observed.
  kDisturbedAt,
  /// 1 where the soil may still move, 0 where it is at rest.
  kActive,
  /// Elevation minus elevation at the start [m].
  kChange,
  /// Components of the unit upward normal in W.
  kNormalX,
  kNormalY,
  kNormalZ,
  /// Volume over bank volume of the uppermost soil.
  kSpecificVolume
};
/// Number of layers.
inline constexpr std::size_t kMapLayers = static_cast<std::size_t>(MapLayer::kSpecificVolume) + 1;

/// Meaning of a layer's numbers. Every layer is stored as float32; pictures and exports look here.
enum class LayerType : std::uint8_t {
  /// Height counted from W z = 0: an export adds the datum of the site's file.
  kHeight,
  /// Signed difference around zero.
  kDifference,
  /// Physical quantity without a natural range.
  kQuantity,
  /// Number from 0 (bad) to 1 (good).
  kShare,
  /// Index into a list; interpolating it makes no sense.
  kIndex,
  /// 0 or 1.
  kFlag,
  /// Simulated time.
  kTime
};

/// Knowledge that a layer needs. Where a source of maps lacks it, the layer is unknown everywhere.
enum class LayerNeeds : std::uint8_t {
  /// Present and initial heights.
  kHeights,
  /// Depth of the soil that rests on the columns as particles.
  kLooseSoil,
  /// Kind and density of the uppermost soil.
  kSoilState,
  /// A design surface.
  kDesign,
  /// Views of the same site at earlier times.
  kHistory
};

/// One row of the table: a layer and the rule that computes it.
struct LayerInfo {
  /// Enumerator of the layer.
  MapLayer layer;
  /// Name in files, options and messages, such as "step_height".
  std::string name;
  /// "m", "rad", "kg/m3", "s" or "-".
  std::string unit;
  /// One line for people.
  std::string meaning;
  /// Meaning of its numbers.
  LayerType type;
  /// The layer is NaN (kUnknown) in every column where this is missing. Formats without NaN write
  /// their own nodata value.
  LayerNeeds needs;
  /// Layers that a map with this layer holds too, because this one is computed from them.
  std::vector<MapLayer> from = {};
  /// Computes the value from the column itself; null for layers of the other two kinds.
  float (*of_column)(const ColumnBlock& block, int ix, int iy) = nullptr;
  /// Computes the value from the elevation of the columns around. Layers with neither function
  /// depend on history: MapMaker stamps them.
  float (*of_surround)(Surround& surround) = nullptr;
  /// False for layers that are written only where somebody names them.
  bool by_default = true;

  /// Returns true for heights in W, to which exports add the datum.
  bool height() const { return type == LayerType::kHeight; }
};

/// Returns the table, in the order of the enumerators.
const std::array<LayerInfo, kMapLayers>& layers();
/// Returns the place of a layer in the table.
inline std::size_t index_of(MapLayer layer) { return static_cast<std::size_t>(layer); }
/// Returns the row of a layer.
inline const LayerInfo& info(MapLayer layer) { return layers()[index_of(layer)]; }
/// Returns the layer called `name`. @throws InputError that suggests the nearest name.
MapLayer layer_named(const std::string& name);
/// Returns the layers of a list such as "slope,soil": each once, in the order given.
/// @throws InputError for an unknown name or an empty list.
std::vector<MapLayer> layers_named(const std::string& list);
/// Returns every layer of the table.
std::vector<MapLayer> all_layers();
/// Returns the layers that a map has when nobody names any.
std::vector<MapLayer> default_layers();

}  // namespace navvy::map
