// SPDX-License-Identifier: Apache-2.0
#include "record/score_json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace navvy::record {
namespace {

using nlohmann::json;

constexpr double kHour = 3600;  // [s]

/// Adds mean and spread under a name that ends in the unit; nothing without values.
void add(json& out, const std::string& name, const std::string& unit, const Spread& values) {
  if (values.count == 0) return;
  out[name + "_mean" + unit] = values.mean;
  out[name + "_spread" + unit] = values.spread;
}

/// Returns the volumes and masses of an area.
json area_json(const AreaScore& area) {
  return {{"cut_m3", area.cut},
          {"fill_m3", area.fill},
          {"rut_cut_m3", area.rut_cut},
          {"rut_fill_m3", area.rut_fill},
          {"lost_kg", kilograms(area.lost)},
          {"gained_kg", kilograms(area.gained)}};
}

/// Returns the comparison with the design.
json shape_json(const ShapeScore& shape) {
  json out = {{"area_m2", shape.area},
              {"cut_area_m2", shape.cut_area},
              {"design_cut_m3", shape.design_cut},
              {"design_fill_m3", shape.design_fill},
              {"completion", shape.completion},
              {"coverage", shape.coverage},
              {"volume_error", shape.volume_error},
              {"rms_error_m", shape.rms},
              {"over_dig_rms_m", shape.over_rms},
              {"over_dig_max_m", shape.over_max},
              {"under_dig_rms_m", shape.under_rms},
              {"under_dig_max_m", shape.under_max}};
  if (shape.batter && shape.design_batter) {
    out["batter_deg"] = degrees(*shape.batter);
    out["design_batter_deg"] = degrees(*shape.design_batter);
  }
  return out;
}

/// Returns the work of one machine.
json machine_json(const MachineScore& one, const scene::Scene& scene) {
  json out = {{"machine", scene.machines[static_cast<std::size_t>(one.machine)].name},
              {"cycles", one.cycles},
              {"distance_driven_m", one.distance},
              {"work_j", one.work}};
  if (one.cycles == 0) return out;
  out["stations"] = one.stations;
  out["reach_area_m2"] = one.reach_area;
  add(out, "dig", "_s", one.cycle.dig);
  add(out, "swing_loaded", "_s", one.cycle.swing_loaded);
  add(out, "dump", "_s", one.cycle.dump);
  add(out, "swing_empty", "_s", one.cycle.swing_empty);
  add(out, "cycle", "_s", one.cycle.whole);
  add(out, "payload", "_kg", one.cycle.payload);
  add(out, "fill_factor", "", one.cycle.fill_factor);
  return out;
}

}  // namespace

json score_json(const Score& score, const scene::Scene& scene) {
  json out = {
      {"inside", area_json(score.inside)},     {"outside", area_json(score.outside)},
      {"bank_volume_m3", score.bank_volume},   {"moved_kg", score.moved},
      {"work_time_s", score.work_time},        {"energy_j", score.energy},
      {"collision_count", score.collisions},   {"stations", score.stations},
      {"distance_driven_m", score.base_moves}, {"balance_error_units", score.balance_error}};
  if (score.work_time > 0) {
    out["bank_volume_m3_per_h"] = score.bank_volume / score.work_time * kHour;
    out["moved_t_per_h"] = score.moved / 1000 / score.work_time * kHour;
  }
  if (score.bank_volume > 0) out["energy_kj_per_m3"] = score.energy / 1000 / score.bank_volume;
  if (score.loads)
    out["loads"] = {{"count", score.loads->count},
                    {"load_error", score.loads->error},
                    {"load_offset_m", score.loads->offset},
                    {"most_passes", score.loads->passes},
                    {"spilt_kg", score.loads->spilt}};
  if (score.shape) {
    out["shape"] = shape_json(*score.shape);
    // As the baselines of the planner Terra define them.
    const double area = score.shape->cut_area;
    if (area > 0 && score.stations > 0) {
      out["path_efficiency"] = score.base_moves / std::sqrt(area);
      out["workspace_efficiency"] = score.reach_area / area;
    }
  }
  out["machines"] = json::array();
  for (const MachineScore& one : score.machines)
    out["machines"].push_back(machine_json(one, scene));
  return out;
}

json goal_list(const std::vector<GoalResult>& goals) {
  json out = json::array();
  for (const GoalResult& one : goals) {
    json row = {
        {"goal", one.name}, {one.at_least ? "at_least" : "at_most", one.bound}, {"met", one.met}};
    if (one.value)
      row["value"] = *one.value;
    else
      row["reason"] = one.reason;
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace navvy::record
