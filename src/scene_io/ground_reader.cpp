// SPDX-License-Identifier: Apache-2.0
#include "scene_io/ground_reader.h"

#include <functional>

#include "scene_io/fields.h"
#include "scene_io/raster_reader.h"

namespace navvy::scene_io {

namespace {

constexpr Range kPlace = {-1e6, 1e6};   // [m]
constexpr Range kLength = {0.01, 1e5};  // [m]

// A name in a layer must be one of the world's soils; a near miss gets the name that was meant.
void require_soil(const Element& element, const std::string& name,
                  const std::vector<scene::Soil>& soils, Faults& faults) {
  std::vector<std::string> names;
  for (const scene::Soil& soil : soils) {
    if (soil.name == name) return;
    names.push_back(soil.name);
  }
  faults.error(
      element, name, "no soil of this name in the world",
      names.empty() ? "add <navvy:soil ref=\"" + name + "\"/>" : faults.nearest(name, names));
}

scene::GroundLayer read_layer(Element& element, const std::vector<scene::Soil>& soils,
                              Faults& faults) {
  scene::GroundLayer layer;
  Fields fields(element, faults);
  fields.text("soil", layer.soil)
      .required("soil")
      .number("thickness_m", layer.thickness, {1e-3, 1e4})
      .finish();
  if (Element* soil = fields.child("soil"); soil && !layer.soil.empty())
    require_soil(*soil, layer.soil, soils, faults);
  // Only the last layer may leave its thickness out: it reaches to the bottom.
  const bool last = element.NextSiblingElement("layer") == nullptr;
  if (!fields.has("thickness_m") && !last)
    faults.error(element, layer.soil,
                 "needs <thickness_m>; only the last layer reaches to the bottom by itself");
  if (Element* thickness = fields.child("thickness_m"); thickness && last)
    faults.warning(*thickness, text_of(*thickness),
                   "the last layer reaches to the rock whatever its thickness",
                   "name the soil below in a <layer> of its own, or leave the thickness out");
  return layer;
}

scene::GroundFeature read_feature(Element& element, scene::GroundFeature::Kind kind,
                                  std::uint64_t seed, Faults& faults) {
  using Kind = scene::GroundFeature::Kind;
  scene::GroundFeature feature;
  feature.kind = kind;
  feature.seed = seed;
  // Hills have no direction and a cone is the same from all sides.
  const bool turned = kind != Kind::kHills && kind != Kind::kStockpile;
  const bool box = kind == Kind::kTrench || kind == Kind::kBlock;
  Fields fields(element, faults);
  if (kind != Kind::kHills) fields.vec2("center_m", feature.center, kPlace);
  if (turned) fields.number("yaw_deg", feature.yaw, {-360, 360}, kDegree);
  if (box)
    fields.number("length_m", feature.length, kLength).number("width_m", feature.width, kLength);
  if (box) fields.required("length_m").required("width_m");
  if (kind == Kind::kTrench)
    fields.number("depth_m", feature.height, {0.01, 1000}).required("depth_m");
  if (kind == Kind::kHills || kind == Kind::kStockpile || kind == Kind::kBank ||
      kind == Kind::kBlock)
    fields.number("height_m", feature.height, {0.01, 1000}).required("height_m");
  if (kind == Kind::kHills) {
    feature.length = 20;
    fields.number("wavelength_m", feature.length, {0.1, 1e5}).whole("seed", feature.seed);
  }
  // Below 60 degrees the tangent stays small enough for a site of kilometres.
  if (kind == Kind::kSlope)
    fields.number("angle_deg", feature.angle, {-60, 60}, kDegree).required("angle_deg");
  if (kind == Kind::kStockpile || kind == Kind::kTrench)
    fields.number("angle_deg", feature.angle, {0, 80}, kDegree);
  if (kind == Kind::kBank) {
    feature.angle = radians(90);
    fields.number("angle_deg", feature.angle, {1, 90}, kDegree);
  }
  fields.finish();
  return feature;
}

/// A rectangle with what `others` adds to the table of its element. The corners are checked here,
/// after the values themselves.
void read_rectangle(Element& element, Vec2& low, Vec2& high, Faults& faults,
                    const std::function<void(Fields&)>& others) {
  Fields fields(element, faults);
  fields.vec2("min_m", low, kPlace).required("min_m").vec2("max_m", high, kPlace).required("max_m");
  others(fields);
  fields.finish();
  if (low.x() >= high.x() || low.y() >= high.y())
    faults.error(element, "", "min_m must be less than max_m in x and y");
}

scene::GroundPatch read_patch(Element& element, const std::vector<scene::Soil>& soils,
                              Faults& faults) {
  scene::GroundPatch patch;
  read_rectangle(element, patch.min, patch.max, faults, [&](Fields& fields) {
    fields
        .each("layer",
              [&](Element& layer) { patch.layers.push_back(read_layer(layer, soils, faults)); })
        .required("layer");
  });
  return patch;
}

scene::ActiveSoil read_active(Element& element, Faults& faults) {
  scene::ActiveSoil active;
  read_rectangle(element, active.min, active.max, faults, [&](Fields& fields) {
    fields.number("bottom_m", active.bottom, {-1e4, 1e4});
  });
  return active;
}

void read_file(Fields& fields, scene::StartGround& ground, Faults& faults) {
  fields.text("file", ground.file);
  Vec2 local = Vec2::Zero();
  fields.vec2("at_m", ground.at, {-1e9, 1e9}).vec2("at_local_m", local, {-1e9, 1e9});
  ground.has_at = fields.has("at_m") || fields.has("at_local_m");
  ground.at_is_local = fields.has("at_local_m");
  if (ground.at_is_local) ground.at = local;
  if (fields.has("at_m") && fields.has("at_local_m"))
    faults.error(*fields.child("at_local_m"), "", "give either at_m or at_local_m", "remove one");
  read_raster_scale(fields, ground.scale);
  if (fields.has("file")) resolve_raster(*fields.child("file"), ground.file, faults);
}

}  // namespace

scene::StartGround read_ground(Element& element, const std::vector<scene::Soil>& soils,
                               std::uint64_t seed, Faults& faults) {
  using Kind = scene::GroundFeature::Kind;
  scene::StartGround ground;
  Fields fields(element, faults);
  read_file(fields, ground, faults);
  fields.vec2("size_m", ground.size, {0.5, 1e5})
      .vec2("origin_m", ground.origin, kPlace)
      .number("surface_m", ground.surface, {-1e4, 1e4})
      .number("depth_m", ground.depth, {0.1, 1000})
      .choice<scene::SteepGround>(
          "steep", ground.steep,
          {{"hold", scene::SteepGround::kHold}, {"settle", scene::SteepGround::kSettle}})
      .each("layer",
            [&](Element& layer) { ground.layers.push_back(read_layer(layer, soils, faults)); })
      .each("patch",
            [&](Element& patch) { ground.patches.push_back(read_patch(patch, soils, faults)); })
      .each("awake",
            [&](Element& active) { ground.active.push_back(read_active(active, faults)); });
  ground.has_origin = fields.has("origin_m");
  if (!ground.has_origin) ground.origin = -0.5 * ground.size;

  // Shapes are summed in file order, whatever their kind.
  const std::vector<std::pair<std::string, Kind>> kinds = {
      {"slope", Kind::kSlope},   {"hills", Kind::kHills}, {"stockpile", Kind::kStockpile},
      {"trench", Kind::kTrench}, {"bank", Kind::kBank},   {"block", Kind::kBlock}};
  for (const auto& [name, kind] : kinds) fields.each(name.c_str(), [](Element&) {});
  for (Element* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    for (const auto& [name, kind] : kinds)
      if (name == child->Name())
        ground.features.push_back(read_feature(*child, kind, seed, faults));
  fields.finish();

  if (!ground.file.empty() && !ground.features.empty())
    faults.error(element, ground.file,
                 "shapes such as slope or hills need a procedural ground, not a file",
                 "remove <file> or the shapes");
  if (ground.file.empty() && ground.scale.any())
    faults.error(element, "", "map_cell_m, map_heights_m, map_corner_m and map_rows need a <file>",
                 "remove them, or name a PNG or NPY");
  if (ground.file.empty() && ground.has_at)
    faults.error(element, "", "at_m and at_local_m need a <file>",
                 "for a procedural ground use origin_m");
  if (ground.layers.empty() && soils.size() == 1)
    ground.layers.push_back({soils[0].name, ground.depth});
  if (ground.layers.empty() && soils.size() > 1)
    faults.error(element, "", "needs <layer> elements, as the world has several soils",
                 "e.g. <layer><soil>" + soils[0].name + "</soil></layer>");
  return ground;
}

}  // namespace navvy::scene_io
