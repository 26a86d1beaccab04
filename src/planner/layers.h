// SPDX-License-Identifier: Apache-2.0
// What planners ask a map for, by name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace navvy::planner {

/// A layer of a map: one float32 for every column of the site, NaN where it is unknown.
/// src/planner/README.md has the formulas.
enum class Layer : std::uint8_t {
  kElevation,       ///< surface in W [m]
  kElevationStart,  ///< of the untouched site [m]
  kTarget,          ///< design surface [m]; unknown without one
  kCutFill,         ///< elevation minus target [m]: above 0 there is still soil to take
  kSlope,           ///< from the horizontal [rad]
  kStepHeight,      ///< largest height between neighbouring columns within the window [m]
  kRoughness,       ///< rms distance from the plane through the window [m]
  kTraversability,  ///< 0 bad .. 1 good
  kLooseDepth,      ///< of soil that lies on the columns as particles [m]
  kDensity,         ///< of the uppermost soil as it lies [kg/m3]
  kSoil,            ///< index of the uppermost soil among the scene's
  kDisturbedAt,     ///< time of the last change that was seen [s]; unknown where there was none
  kAwake            ///< 1 where the soil may still move, 0 where it rests
};
inline constexpr std::size_t kLayers = 13;

/// What a person reads of a layer.
struct LayerInfo {
  Layer layer;
  std::string name;     ///< "step_height"
  std::string unit;     ///< "m", "rad", "kg/m3", "s", "-"
  std::string meaning;  ///< one line
  bool height = false;  ///< counted from W z = 0: an export adds the datum
};

/// All layers, in the order of the enumerators.
const std::array<LayerInfo, kLayers>& layers();
inline std::size_t index_of(Layer layer) { return static_cast<std::size_t>(layer); }
inline const LayerInfo& info(Layer layer) { return layers()[index_of(layer)]; }
/// The layer called `name`. @throws InputError naming the nearest one.
Layer layer_named(const std::string& name);
/// Of "slope,soil"; each once, in the order asked for. @throws InputError likewise, also for an
/// empty list.
std::vector<Layer> layers_named(const std::string& list);
std::vector<Layer> all_layers();

}  // namespace navvy::planner
