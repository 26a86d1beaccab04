// SPDX-License-Identifier: Apache-2.0
#include "record/replay_shapes.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/log.h"
#include "geometry/simplify.h"
#include "record/replay_packing.h"
#include "sensor/shape_mesh.h"
#include "sim/cylinder_shapes.h"

namespace navvy::record {
namespace {

using geometry::TriangleMesh;
using nlohmann::json;

constexpr std::size_t kMostTriangles = 3000;  // of one visual

json triangles_of(const TriangleMesh& mesh, const std::vector<std::size_t>& chosen) {
  std::vector<float> points;
  std::vector<std::uint32_t> corners;
  std::map<int, std::uint32_t> number;  // of the vertices in use
  for (const std::size_t t : chosen)
    for (const int v : mesh.triangles[t]) {
      const auto [found, added] =
          number.try_emplace(v, static_cast<std::uint32_t>(points.size() / 3));
      if (added)
        for (const double x : mesh.vertices[static_cast<std::size_t>(v)])
          points.push_back(static_cast<float>(x));
      corners.push_back(found->second);
    }
  return {{"points", packed(points)}, {"triangles", packed(corners)}};
}

/// Appends a visual for each material of a mesh.
void add_mesh(const scene::Visual& visual, json& out) {
  TriangleMesh mesh;
  try {
    mesh = geometry::simplified(sensor::mesh_of(visual.geometry), kMostTriangles);
  } catch (const Error& error) {
    log(LogLevel::kWarning, std::string("a shape is missing in the replay: ") + error.what());
    return;
  }
  std::map<int, std::vector<std::size_t>> by_material;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    by_material[mesh.material_of.empty() ? -1 : mesh.material_of[t]].push_back(t);
  for (const auto& [material, triangles] : by_material) {
    json color = {visual.color.r, visual.color.g, visual.color.b};
    if (material >= 0) color = mesh.materials[static_cast<std::size_t>(material)].diffuse;
    out.push_back({{"pose", json_of(visual.X_LV)},
                   {"color", color},
                   {"mesh", triangles_of(mesh, triangles)}});
  }
}

void add_visual(const scene::Visual& visual, json& out) {
  using Kind = scene::Geometry::Kind;
  const scene::Geometry& shape = visual.geometry;
  json entry = {{"pose", json_of(visual.X_LV)},
                {"color", {visual.color.r, visual.color.g, visual.color.b}}};
  if (shape.kind == Kind::kBox)
    entry["box"] = {shape.size.x(), shape.size.y(), shape.size.z()};
  else if (shape.kind == Kind::kCylinder)
    entry["cylinder"] = {shape.radius, shape.length};
  else if (shape.kind == Kind::kSphere)
    entry["sphere"] = shape.radius;
  else
    return add_mesh(visual, out);
  out.push_back(std::move(entry));
}

}  // namespace

json replay_links(const scene::Scene& scene) {
  json out = json::array();
  for (const scene::MachineInWorld& placed : scene.machines)
    for (const scene::Link& link : placed.machine.links) {
      json visuals = json::array();
      for (const scene::Visual& visual : link.visuals) add_visual(visual, visuals);
      out.push_back(
          {{"machine", placed.name}, {"link", link.name}, {"visuals", std::move(visuals)}});
    }
  return out;
}

json replay_cylinders(const sim::World& world) {
  json out = json::array();
  const auto& machines = world.description().machines;
  for (std::size_t m = 0; m < machines.size(); ++m) {
    std::vector<scene::FrameCylinder> cylinders;
    sim::add_cylinder_shapes(world, static_cast<int>(m), cylinders);
    for (const scene::FrameCylinder& one : cylinders)
      out.push_back({{"machine", machines[m].name},
                     {"radius_m", one.radius},
                     {"barrel_length_m", one.barrel_length}});
  }
  return out;
}

json replay_forces(const scene::Scene& scene) {
  json out = json::array();
  for (const scene::MachineInWorld& placed : scene.machines)
    for (const scene::Shell& shell : placed.machine.shells)
      out.push_back({{"name", placed.name + "/" + shell.name}});
  return out;
}

}  // namespace navvy::record
