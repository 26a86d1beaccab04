// SPDX-License-Identifier: Apache-2.0
// The layers of a terrain map: a table with the name, the unit and the formula of each layer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace navvy::map {

class ColumnBlock;
class Surround;

/// A layer of a terrain map, which has one float32 per column of the site, and NaN where the value
/// is unknown. src/map/README.md gives the formulas. To add a layer, add an enumerator here and a
/// row in map_layers.cpp.
enum class MapLayer : std::uint8_t {
  /// World z of the surface [m].
  kElevation,
  /// World z of the initial ground surface [m].
  kElevationStart,
  /// World z of the design surface [m]; unknown if the scene has no design.
  kTarget,
  /// Elevation minus target [m]; positive where soil must still be removed.
  kCutFill,
  /// Angle of the surface from the horizontal [rad].
  kSlope,
  /// Largest height difference between columns that share an edge, within
  /// TraversabilityLimits::window [m].
  kStepHeight,
  /// Rms distance of the surface from its least-squares plane, within TraversabilityLimits::window
  /// [m].
  kRoughness,
  /// Traversability for a machine, from 0 (not drivable) to 1 (best).
  kTraversability,
  /// Depth of the loose soil on the column, which consists of particles [m].
  kLooseDepth,
  /// Bulk density of the uppermost soil in its current state [kg/m3].
  kDensity,
  /// Index of the uppermost soil in the scene's list of soils.
  kSoil,
  /// Simulated time at which the column last changed [s]; unknown if no change was observed.
  kDisturbedAt,
  /// 1 if the column has loose soil, which may still move; 0 if its soil is at rest.
  kActive,
  /// Elevation minus initial elevation [m].
  kChange,
  /// x component of the unit upward normal, in world axes.
  kNormalX,
  /// y component of the unit upward normal, in world axes.
  kNormalY,
  /// z component of the unit upward normal, in world axes.
  kNormalZ,
  /// Volume divided by bank volume of the uppermost soil [-].
  kSpecificVolume,
  /// Height of a body's top above the surface [m]; 0 where no body stands.
  kOccupied
};
/// Number of map layers.
inline constexpr std::size_t kMapLayers = static_cast<std::size_t>(MapLayer::kOccupied) + 1;

/// Meaning of a layer's values, which determines how pictures and exported files show them.
enum class LayerType : std::uint8_t {
  /// Values are heights as world z. Exported files contain them in the vertical datum of the site's
  /// terrain file.
  kHeight,
  /// Values are differences of two heights, positive or negative.
  kDifference,
  /// Values are a physical quantity without a natural range.
  kQuantity,
  /// Values are ratings from 0 (bad) to 1 (good).
  kShare,
  /// Values are indices into a list. Interpolating them gives no meaningful result.
  kIndex,
  /// Values are 0 (false) or 1 (true).
  kFlag,
  /// Values are simulated times [s].
  kTime
};

/// Data that a layer is computed from. The layer is unknown everywhere if a source of maps does not
/// have them.
enum class LayerNeeds : std::uint8_t {
  /// The layer is computed from current and initial heights.
  kHeights,
  /// The layer is computed from the depth of loose soil on the columns.
  kLooseSoil,
  /// The layer is computed from type and density of the uppermost soil.
  kSoilState,
  /// The layer is computed from a design surface.
  kDesign,
  /// The layer is computed from terrain views at several times.
  kHistory
};

/// One row of the layer table: properties of a layer, and the function that computes it.
struct LayerInfo {
  /// Enumerator of the layer.
  MapLayer layer;
  /// Name in files, options and messages, such as "step_height".
  std::string name;
  /// Unit of the values: "m", "rad", "kg/m3", "s" or "-".
  std::string unit;
  /// One-line description for the user.
  std::string meaning;
  /// Meaning of the layer's values.
  LayerType type;
  /// Data that the layer is computed from. Without them the layer is NaN (kUnknown) in every
  /// column. File formats without NaN write their own nodata value.
  LayerNeeds needs;
  /// Layers that this one is computed from. A map with this layer contains them as well.
  std::vector<MapLayer> from = {};
  /// Function that computes the layer's value from the state of column (ix, iy). Null for layers
  /// that are not computed from a single column.
  float (*of_column)(const ColumnBlock& block, int ix, int iy) = nullptr;
  /// Function that computes the layer's value from the elevation of nearby columns. Null for other
  /// layers. If `of_column` is null too, the layer depends on history, and MapMaker sets its
  /// values.
  float (*of_surround)(Surround& surround) = nullptr;
  /// False for layers that a map contains only if they are requested by name.
  bool by_default = true;

  /// Returns true if the values are world z, which exported files convert to the vertical datum of
  /// the terrain file.
  bool height() const { return type == LayerType::kHeight; }
};

/// Returns the layer table, in the order of the enumerators of MapLayer.
const std::array<LayerInfo, kMapLayers>& layers();
/// Returns the index of `layer` in the layer table.
inline std::size_t index_of(MapLayer layer) { return static_cast<std::size_t>(layer); }
/// Returns the row of `layer` in the layer table.
inline const LayerInfo& info(MapLayer layer) { return layers()[index_of(layer)]; }
/// Returns the layer called `name`. Names from earlier releases are accepted too. @throws
/// InputError that suggests the most similar name.
MapLayer layer_named(const std::string& name);
/// Parses a comma-separated list of layer names, such as "slope,soil". Returns each layer once, in
/// the order of the list.
/// @throws InputError for an unknown name or an empty list.
std::vector<MapLayer> layers_named(const std::string& list);
/// Returns all layers of the layer table.
std::vector<MapLayer> all_layers();
/// Returns the layers that a map contains if none are requested by name.
std::vector<MapLayer> default_layers();

}  // namespace navvy::map
