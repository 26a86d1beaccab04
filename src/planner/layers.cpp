// SPDX-License-Identifier: Apache-2.0
// The table of layers and the look-up in it. What a layer's value is stands in map_maker.cpp and
// derived.cpp.
#include "planner/layers.h"

#include <algorithm>
#include <sstream>

#include "core/edit_distance.h"
#include "core/error.h"

namespace navvy::planner {

const std::array<LayerInfo, kLayers>& layers() {
  // One row an enumerator, in their order; a test compares the two.
  static const std::array<LayerInfo, kLayers> table = {{
      {Layer::kElevation, "elevation", "m", "height of the surface", true},
      {Layer::kElevationStart, "elevation_start", "m", "height of the untouched site", true},
      {Layer::kTarget, "target", "m", "height of the design surface", true},
      {Layer::kCutFill, "cut_fill", "m", "elevation minus target"},
      {Layer::kSlope, "slope", "rad", "angle of the surface from the horizontal"},
      {Layer::kStepHeight, "step_height", "m",
       "largest height between neighbouring columns nearby"},
      {Layer::kRoughness, "roughness", "m",
       "rms distance from the plane through the columns nearby"},
      {Layer::kTraversability, "traversability", "-", "0 bad .. 1 good"},
      {Layer::kLooseDepth, "loose_depth", "m",
       "depth of the soil that lies on the columns as particles"},
      {Layer::kDensity, "density", "kg/m3", "bulk density of the uppermost soil as it lies"},
      {Layer::kSoil, "soil", "-", "index of the uppermost soil"},
      {Layer::kDisturbedAt, "disturbed_at", "s", "time of the last change that was seen"},
      {Layer::kAwake, "awake", "-", "1 where the soil may still move"},
  }};
  return table;
}

Layer layer_named(const std::string& name) {
  // A dozen of them: a look-up by name is for once.
  std::vector<std::string> names;
  for (const LayerInfo& each : layers()) {
    if (each.name == name) return each.layer;
    names.push_back(each.name);
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "layer", name, "no such layer",
                         suggestion(name, names)});
}

std::vector<Layer> layers_named(const std::string& list) {
  std::vector<Layer> out;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    // Twice asked for is once written: names of bands and arrays are unique.
    const Layer layer = layer_named(word);
    if (std::find(out.begin(), out.end(), layer) == out.end()) out.push_back(layer);
  }
  // An empty list would make a file of nothing.
  if (out.empty()) return {layer_named("")};
  return out;
}

std::vector<Layer> all_layers() {
  std::vector<Layer> out;
  for (const LayerInfo& each : layers()) out.push_back(each.layer);
  return out;
}

}  // namespace navvy::planner
