// SPDX-License-Identifier: Apache-2.0
#include "record/summary.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

namespace navvy::record {
namespace {

using nlohmann::json;

/// Shares of the wall time spent stepping, by module; the rest is "other".
json time_shares(const sim::Session& session, const RunStatus& status) {
  const coupling::TimeShare& share = session.world().coupling().time_share();
  const double total = std::max(status.wall_time + status.render_time + status.record_time, 1e-9);
  json out;
  out["vehicle"] = share.vehicle / total;
  out["soil"] = share.soil / total;
  out["ground"] = share.ground / total;
  out["control"] = session.control_time() / total;
  out["render"] = status.render_time / total;
  out["record"] = status.record_time / total;
  double known = 0;
  for (const auto& value : out) known += value.get<double>();
  out["other"] = std::max(0.0, 1 - known);
  return out;
}

json cycle_list(const sim::Session& session) {
  json cycles = json::array();
  for (const sim::Cycle& cycle : session.cycles())
    cycles.push_back({{"machine", session.world().description().machines[static_cast<std::size_t>(cycle.machine)].name},
                      {"start_s", cycle.start},
                      {"lift_out_s", cycle.lift_out},
                      {"dump_start_s", cycle.dump_start},
                      {"end_s", cycle.end},
                      {"payload_at_lift_out_kg", cycle.payload_lift_out},
                      {"payload_at_dump_kg", cycle.payload_dump},
                      {"force_peak_n", cycle.force_peak}});
  return cycles;
}

json tip_list(const sim::Session& session) {
  json tips = json::array();
  for (const sim::BedTip& tip : session.tips())
    tips.push_back({{"machine", session.world().description().machines[static_cast<std::size_t>(tip.machine)].name},
                    {"start_s", tip.start},
                    {"end_s", tip.end},
                    {"payload_at_start_kg", tip.payload_start},
                    {"payload_at_end_kg", tip.payload_end}});
  return tips;
}

/// What buckets and beds hold now, by "machine/shell".
json carried(const sim::Session& session) {
  json out = json::object();
  for (const coupling::ToolLoad& tool : session.world().coupling().tools()) {
    const scene::MachineInWorld& placed =
        session.world().description().machines[static_cast<std::size_t>(tool.machine)];
    if (placed.machine.is_bucket(tool.shell) || placed.machine.is_bed(tool.shell))
      out[placed.name + "/" + placed.machine.shells[static_cast<std::size_t>(tool.shell)].name] =
          session.world().coupling().payload(tool);
  }
  return out;
}

json ledger(const sim::Session& session) {
  const soil::Ledger sums = session.world().soil().ledger();
  json soils = json::array();
  for (std::size_t i = 0; i < sums.columns.size(); ++i)
    soils.push_back({{"soil", session.world().description().soils[i].name},
                     {"columns_change_kg", kilograms(sums.columns[i])},
                     {"particles_kg", kilograms(sums.particles[i])},
                     {"left_site_kg", kilograms(sums.left_site[i])},
                     {"loaded_kg", kilograms(sums.inserted[i])}});
  return {{"error_units", sums.error()}, {"unit_kg", kMassQuantum}, {"soils", soils}};
}

/// Bank volume of each soil in a column [m3].
void bank_volumes(const std::vector<heightfield::Layer>& column, const std::vector<scene::Soil>& soils,
                  std::vector<double>& volumes) {
  volumes.assign(soils.size(), 0.0);
  for (const heightfield::Layer& layer : column)
    volumes[layer.soil] += kilograms(layer.mass) / soils[layer.soil].bank_density;
}

}  // namespace

Earthwork measure_earthwork(const sim::World& world) {
  const heightfield::Ground& ground = world.ground();
  const std::vector<scene::Soil>& soils = ground.setup().soils;
  std::map<std::pair<int, int>, std::vector<double>> awake;  // bank volumes over columns [m3]
  for (const soil::Particle& p : world.soil().particles()) {
    std::vector<double>& volumes = awake[world.soil().grid().column_of(p)];
    volumes.resize(soils.size());
    volumes[p.soil] += kilograms(p.mass) / soils[p.soil].bank_density;
  }
  Earthwork sum;
  sum.soils.resize(soils.size());
  const heightfield::CellRect rect = ground.touched_rect();
  const double area = ground.cell() * ground.cell();
  // A twentieth of a cell keeps the rounding of woken and rebooked columns out of the sums.
  const double least = 0.05 * area * ground.cell();
  std::vector<heightfield::Layer> now, start;
  std::vector<double> after, before;
  for (int iy = std::max(rect.y0, 0); iy < std::min(rect.y1, ground.ny()); ++iy)
    for (int ix = std::max(rect.x0, 0); ix < std::min(rect.x1, ground.nx()); ++ix) {
      ground.column(ix, iy, now);
      ground.start_column(ix, iy, start);
      bank_volumes(now, soils, after);
      bank_volumes(start, soils, before);
      const auto above = awake.find({ix, iy});
      double gain = 0;
      for (std::size_t i = 0; i < soils.size(); ++i) {
        const double change = after[i] + (above == awake.end() ? 0.0 : above->second[i]) - before[i];
        gain += change;
        if (change < -least) sum.soils[i].dug -= change * soils[i].bank_density;
        if (change > least) sum.soils[i].spoil += change * soils[i].bank_density;
      }
      if (gain < -least) sum.bank_volume -= gain;
      if (gain > least) sum.loose_volume += area * (ground.height(ix, iy) - ground.start_height(ix, iy));
    }
  return sum;
}

std::string summary_json(const sim::Session& session, const RunStatus& status, bool with_hash) {
  const sim::World& world = session.world();
  const Earthwork earth = measure_earthwork(world);
  const soil::SolverStats& stats = world.soil().stats();
  json out;
  out["schema_version"] = kSummarySchemaVersion;
  out["scenario"] = world.description().name;
  out["status"] = status.status;
  if (!status.message.empty()) out["message"] = status.message;
  out["device"] = session.device_name();
  out["steps"] = world.steps();
  out["step_s"] = world.dt();
  out["wall_time_s"] = status.wall_time;
  out["render_time_s"] = status.render_time;
  out["simulated_time_s"] = world.time();
  out["real_time_factor"] = status.wall_time > 0 ? (world.time() - status.start_time) / status.wall_time : 0.0;
  out["time_share"] = time_shares(session, status);
  for (const auto& [stage, seconds] : world.soil().stage_times()) out["soil_stage_s"][stage] = seconds;
  out["cycles"] = session.cycles().size();
  out["cycle_list"] = cycle_list(session);
  out["payload_kg"] = json::array();
  for (const sim::Cycle& cycle : session.cycles()) out["payload_kg"].push_back(cycle.payload_lift_out);
  out["tip_list"] = tip_list(session);
  out["carried_kg"] = carried(session);
  out["bank_volume_m3"] = earth.bank_volume;
  out["loose_volume_m3"] = earth.loose_volume;
  for (std::size_t i = 0; i < earth.soils.size(); ++i)
    out["earthwork"].push_back({{"soil", world.description().soils[i].name},
                                {"dug_kg", earth.soils[i].dug},
                                {"spoil_kg", earth.soils[i].spoil}});
  out["energy_j"] = session.energy();
  out["bucket_force_peak_n"] = session.force().peak;
  out["bucket_force_mean_n"] = session.force().mean();
  out["rock_force_peak_n"] = session.force().rock_peak;
  out["momentum_residual_max"] = session.force().residual_max;
  out["particles_peak"] = stats.particles_peak;
  out["particle_steps"] = stats.particle_steps;
  out["shell_crossings"] = stats.shell_crossings;
  out["rebins"] = stats.rebins;
  out["woken_columns"] = stats.wakes;
  out["deposited_blocks"] = stats.deposits;
  out["frames"] = status.frames;
  out["mass_ledger"] = ledger(session);
  out["state_hash"] = with_hash ? json(session.state_hash()) : json(nullptr);
  return out.dump(2) + "\n";
}

}  // namespace navvy::record
