// SPDX-License-Identifier: Apache-2.0
// Each row holds its layer's rule; rules of more than one line stand in derived_layers.cpp.
#include "map/map_layers.h"

#include <algorithm>
#include <sstream>

#include "core/edit_distance.h"
#include "core/error.h"
#include "core/renamed_names.h"
#include "map/column_block.h"
#include "map/derived_layers.h"

namespace navvy::map {
namespace {

using enum MapLayer;
using Block = const ColumnBlock&;

}  // namespace

// One table, whose length grows with its rows. NOLINTNEXTLINE(readability-function-size)
const std::array<LayerInfo, kMapLayers>& layers() {
  // In the order of the enumerators; a test compares the two.
  static const std::array<LayerInfo, kMapLayers> table = {{
      {.layer = kElevation,
       .name = "elevation",
       .unit = "m",
       .meaning = "height of the surface",
       .type = LayerType::kHeight,
       .needs = LayerNeeds::kHeights,
       .of_column = [](Block b, int ix, int iy) { return b.elevation(ix, iy); }},
      {.layer = kElevationStart,
       .name = "elevation_start",
       .unit = "m",
       .meaning = "height of the untouched site",
       .type = LayerType::kHeight,
       .needs = LayerNeeds::kHeights,
       .of_column = [](Block b, int ix,
                       int iy) { return static_cast<float>(b.site().start_height(ix, iy)); }},
      {.layer = kTarget,
       .name = "target",
       .unit = "m",
       .meaning = "height of the design surface",
       .type = LayerType::kHeight,
       .needs = LayerNeeds::kDesign,
       .of_column = [](Block b, int ix, int iy) { return b.site().target(ix, iy); }},
      {.layer = kCutFill,
       .name = "cut_fill",
       .unit = "m",
       .meaning = "elevation minus target",
       .type = LayerType::kDifference,
       .needs = LayerNeeds::kDesign,
       // Both are single floats, as in the layers of a map: a reader who subtracts those gets this
       // value.
       .from = {kElevation, kTarget},
       .of_column = [](Block b, int ix,
                       int iy) { return b.elevation(ix, iy) - b.site().target(ix, iy); }},
      {.layer = kSlope,
       .name = "slope",
       .unit = "rad",
       .meaning = "angle of the surface from the horizontal",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .from = {kElevation},
       .of_surround = [](Surround& s) { return s.slope(); }},
      {.layer = kStepHeight,
       .name = "step_height",
       .unit = "m",
       .meaning = "largest height between neighbouring columns nearby",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .from = {kElevation},
       .of_surround = [](Surround& s) { return s.step_height(); }},
      {.layer = kRoughness,
       .name = "roughness",
       .unit = "m",
       .meaning = "rms distance from the plane through the columns nearby",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .from = {kElevation},
       .of_surround = [](Surround& s) { return s.plane().roughness; }},
      {.layer = kTraversability,
       .name = "traversability",
       .unit = "-",
       .meaning = "0 bad .. 1 good",
       .type = LayerType::kShare,
       .needs = LayerNeeds::kHeights,
       // A body counts through `occupied`, so a map with this layer shows why ground is blocked.
       .from = {kSlope, kStepHeight, kRoughness, kElevation, kOccupied},
       .of_surround =
           [](Surround& s) {
             const float ground = traversability(s.plane().inclination, s.step_height(),
                                                 s.plane().roughness, s.limits());
             // The comparison is false for NaN, so a body does not turn unknown ground into known
             // ground.
             return s.blocked() && ground > 0 ? 0.0f : ground;
           }},
      {.layer = kLooseDepth,
       .name = "loose_depth",
       .unit = "m",
       .meaning = "depth of the soil that rests on the columns as particles",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kLooseSoil,
       .of_column = [](Block b, int ix, int iy) { return b.site().loose_depth(ix, iy); }},
      {.layer = kDensity,
       .name = "density",
       .unit = "kg/m3",
       .meaning = "bulk density of the uppermost soil in its present state",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kSoilState,
       .of_column = [](Block b, int ix, int iy) { return b.site().density(ix, iy); }},
      {.layer = kSoil,
       .name = "soil",
       .unit = "-",
       .meaning = "index of the uppermost soil",
       .type = LayerType::kIndex,
       .needs = LayerNeeds::kSoilState,
       .of_column = [](Block b, int ix, int iy) { return b.site().soil(ix, iy); }},
      {.layer = kDisturbedAt,
       .name = "disturbed_at",
       .unit = "s",
       .meaning = "time of the last observed change",
       .type = LayerType::kTime,
       .needs = LayerNeeds::kHistory,
       // A change of any of these stamps the column.
       .from = {kElevation, kSoil, kDensity, kLooseDepth, kOccupied}},
      {.layer = kActive,
       .name = "active",
       .unit = "-",
       .meaning = "1 where the soil may still move",
       .type = LayerType::kFlag,
       .needs = LayerNeeds::kLooseSoil,
       .of_column = [](Block b, int ix,
                       int iy) { return b.site().loose_depth(ix, iy) > 0 ? 1.0f : 0.0f; }},
      {.layer = kChange,
       .name = "change",
       .unit = "m",
       .meaning = "elevation minus elevation_start",
       .type = LayerType::kDifference,
       .needs = LayerNeeds::kHeights,
       // Subtracted in doubles: single floats at a height of 500 m are 0.03 mm apart.
       .of_column =
           [](Block b, int ix, int iy) {
             return static_cast<float>(b.site().height(ix, iy) - b.site().start_height(ix, iy));
           },
       .by_default = false},
      // A layer has one number per column, so the normal takes three layers.
      {.layer = kNormalX,
       .name = "normal_x",
       .unit = "-",
       .meaning = "unit upward normal in W, x",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .from = {kElevation},
       .of_surround = [](Surround& s) { return s.normal(0); },
       .by_default = false},
      {.layer = kNormalY,
       .name = "normal_y",
       .unit = "-",
       .meaning = "unit upward normal in W, y",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .from = {kElevation},
       .of_surround = [](Surround& s) { return s.normal(1); },
       .by_default = false},
      {.layer = kNormalZ,
       .name = "normal_z",
       .unit = "-",
       .meaning = "unit upward normal in W, z",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .from = {kElevation},
       .of_surround = [](Surround& s) { return s.normal(2); },
       .by_default = false},
      {.layer = kSpecificVolume,
       .name = "specific_volume",
       .unit = "-",
       .meaning = "volume over bank volume of the uppermost soil",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kSoilState,
       .of_column = [](Block b, int ix, int iy) { return b.site().specific_volume(ix, iy); },
       .by_default = false},
      {.layer = kOccupied,
       .name = "occupied",
       .unit = "m",
       .meaning = "height of a body's top above the surface, 0 without a body",
       .type = LayerType::kQuantity,
       .needs = LayerNeeds::kHeights,
       .of_column = [](Block b, int ix, int iy) { return b.site().occupied(ix, iy); },
       .by_default = false},
  }};
  return table;
}

// There are few layers, and names are looked up once per command or request.
MapLayer layer_named(const std::string& name) {
  // Earlier releases had other names for some layers.
  const std::string current = current_name(NameKind::kLayer, name);
  std::vector<std::string> names;
  for (const LayerInfo& each : layers()) {
    if (each.name == current) return each.layer;
    names.push_back(each.name);
  }
  throw InputError(Fault{Fault::Severity::kError, "", 0, "layer", name,
                         "is not the name of a layer", suggestion(name, names)});
}

std::vector<MapLayer> layers_named(const std::string& list) {
  std::vector<MapLayer> out;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    // A layer named twice is written once: names of bands and arrays are unique.
    const MapLayer layer = layer_named(word);
    if (std::find(out.begin(), out.end(), layer) == out.end()) out.push_back(layer);
  }
  // An empty list would make an empty file; the empty name is refused like any other unknown one.
  if (out.empty()) return {layer_named("")};
  return out;
}

std::vector<MapLayer> all_layers() {
  std::vector<MapLayer> out;
  for (const LayerInfo& each : layers()) out.push_back(each.layer);
  return out;
}

std::vector<MapLayer> default_layers() {
  std::vector<MapLayer> out;
  for (const LayerInfo& each : layers())
    if (each.by_default) out.push_back(each.layer);
  return out;
}

}  // namespace navvy::map
