// SPDX-License-Identifier: Apache-2.0
#include "record/summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/printable.h"
#include "device/traffic.h"
#include "heightfield/design_surface.h"
#include "record/earthwork.h"
#include "record/program_list.h"
#include "record/score.h"
#include "record/score_json.h"
#include "sensor/sensor_output.h"
#include "sim/world_terrain.h"

namespace navvy::record {
namespace {

using nlohmann::json;

/// Returns the fraction of wall time of each module. The remainder is "other", so they sum to 1.
json time_shares(const session::Session& session, const RunStatus& status) {
  const sim::WallTimes share = session.world().wall_times();
  // Avoids a division by zero in a run without steps.
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

/// Returns the difference between two energy accounts, term by term; `before` may be null.
json soil_energy(const sim::SoilEnergy& now, const sim::SoilEnergy* before) {
  json out;
  for (std::size_t i = 0; i < now.size(); ++i)
    out[now[i].name] = now[i].joule - (before != nullptr ? before->at(i).joule : 0);
  return out;
}

/// Returns an entry for each cycle of any machine, in the order in which they ended.
json cycle_list(const session::Session& session) {
  json cycles = json::array();
  for (const session::Cycle& cycle : session.cycles())
    cycles.push_back(
        {{"machine",
          session.world().description().machines[static_cast<std::size_t>(cycle.machine)].name},
         {"start_s", cycle.start},
         {"curl_s", cycle.curl},
         {"lift_out_s", cycle.lift_out},
         {"dump_start_s", cycle.dump_start},
         {"end_s", cycle.end},
         {"payload_at_lift_out_kg", cycle.payload_lift_out},
         {"payload_at_dump_kg", cycle.payload_dump},
         {"force_peak_n", cycle.force_peak},
         {"draft_peak_n", cycle.draft_peak},
         {"uplift_peak_n", cycle.uplift_peak}});
  // The energy of a cycle counts from the end of the previous one, so the entries sum to the energy
  // of the run up to the last cycle.
  const auto& ends = session.energy_at_ends();
  for (std::size_t i = 0; i < std::min(ends.size(), cycles.size()); ++i)
    if (ends[i])
      cycles[i]["soil_energy_j"] =
          soil_energy(*ends[i], i > 0 && ends[i - 1] ? &*ends[i - 1] : nullptr);
  return cycles;
}

/// Returns an entry for each tip of a bed.
json tip_list(const session::Session& session) {
  json tips = json::array();
  for (const session::BedTip& tip : session.tips())
    tips.push_back(
        {{"machine",
          session.world().description().machines[static_cast<std::size_t>(tip.machine)].name},
         {"start_s", tip.start},
         {"end_s", tip.end},
         {"payload_at_start_kg", tip.payload_start},
         {"payload_at_end_kg", tip.payload_end}});
  return tips;
}

/// Returns an entry with the names of two links.
json names_of(const session::Session& session, const sim::LinkPair& links) {
  const sim::MachineHandle machine = session.world().machines().at(links.machine),
                           other = session.world().machines().at(links.other_machine);
  return {{"machine", machine.name()},
          {"link", machine.link(links.link).name()},
          {"other_machine", other.name()},
          {"other_link", other.link(links.other_link).name()}};
}

/// Returns the sensors with their numbers of readings.
json sensor_list(const sim::World& world) {
  json out = json::array();
  for (const sensor::SensorOutput& one : sensor::sensor_outputs(world))
    out.push_back({{"name", one.name},
                   {"type", one.description->type},
                   {"link", one.link_name},
                   {"rate_hz", one.description->rate},
                   {"latency_s", one.description->latency},
                   {"readings", world.arrays().view(one.arrays.front().index).sequence()}});
  return out;
}

/// Returns an entry for each collision of two links.
json collision_list(const session::Session& session) {
  json list = json::array();
  for (const session::MachineCollision& one : session.collisions().collisions()) {
    list.push_back(names_of(session, one));
    list.back().update({{"start_s", one.start},
                        {"end_s", one.end},
                        {"force_peak_n", one.force_peak},
                        {"depth_m", one.depth_peak}});
  }
  return list;
}

/// Returns an entry for each lasting overlap of two links.
json overlap_list(const session::Session& session) {
  json list = json::array();
  for (const session::BodyOverlap& one : session.overlaps().overlaps()) {
    list.push_back(names_of(session, one));
    list.back().update({{"start_s", one.start},
                        {"end_s", one.end},
                        {"depth_m", one.depth_peak},
                        {"depth_share", one.share_peak}});
  }
  return list;
}

/// Returns the present payload of buckets and beds [kg], by "machine/shell".
json carried(const session::Session& session) {
  json out = json::object();
  // Blades and plates carry no payload.
  for (const sim::ToolHandle& tool : session.world().machines().tools())
    if (tool.is_bucket() || tool.is_bed())
      out[session.world().machines().at(tool.machine()).name() + "/" + tool.name()] =
          tool.payload();
  return out;
}

/// Returns the mass ledger. Its error is an exact integer; kilograms are for people.
json ledger(const session::Session& session, const sim::ActivePlaces& active) {
  const sim::MassLedger sums = session.world().soil().mass_ledger();
  json soils = json::array();
  // One entry per soil, with its name in the scene.
  for (std::size_t i = 0; i < sums.columns.size(); ++i)
    soils.push_back({{"soil", session.world().description().soils[i].name},
                     {"columns_change_kg", kilograms(sums.columns[i])},
                     {"particles_kg", kilograms(sums.particles[i])},
                     {"resting_kg", kilograms(active.resting[i])},
                     {"held_kg", kilograms(active.held[i])},
                     {"elsewhere_kg", kilograms(active.elsewhere[i])},
                     {"left_site_kg", kilograms(sums.left_site[i])},
                     {"loaded_kg", kilograms(sums.inserted[i])}});
  return {{"error_units", sums.error}, {"unit_kg", kMassQuantum}, {"soils", soils}};
}

/// Compares the ground with its design. Active soil counts where it is.
json design_comparison(const sim::World& world, const sim::ActivePlaces& active,
                       const heightfield::DesignSurface& design) {
  const heightfield::DesignComparison f = heightfield::against_design(
      world.ground().view(world.time()).with(active.on_ground, heightfield::SurfaceKind::kMapped),
      design);
  return {{"area_m2", f.area},
          {"design_cut_m3", f.design_cut},
          {"design_fill_m3", f.design_fill},
          {"cut_m3", f.cut},
          {"fill_m3", f.fill},
          {"over_dig_m3", f.over_dig},
          {"under_dig_m3", f.under_dig},
          {"mean_error_m", f.mean_error},
          {"mean_error_size_m", f.mean_size},
          {"largest_error_m", f.largest_error}};
}

/// Adds what programs, machines and bodies did to `out`.
void add_programs(const session::Session& session, const std::string& status, json& out) {
  out["programs"] = program_list(session, status);
  out["cycles"] = session.cycles().size();
  out["cycle_list"] = cycle_list(session);
  // The payload of each cycle at the lift out of the ground, for a quick look.
  out["payload_kg"] = json::array();
  for (const session::Cycle& cycle : session.cycles())
    out["payload_kg"].push_back(cycle.payload_lift_out);
  out["tip_list"] = tip_list(session);
  out["carried_kg"] = carried(session);
  if (json sensors = sensor_list(session.world()); !sensors.empty()) out["sensors"] = sensors;
  out["collisions"] = collision_list(session);
  out["collision_count"] = session.collisions().count();
  out["overlaps"] = overlap_list(session);
  out["overlap_count"] = session.overlaps().count();
  // Absent in a run without one.
  if (const auto& event = session.forbidden())
    out["forbidden_event"] = {
        {"event", event->event}, {"reason", event->reason}, {"time_s", event->time}};
}

/// Adds the shape of the ground and the score to `out`.
void add_ground(const session::Session& session, const sim::ActivePlaces& active, json& out) {
  const sim::World& world = session.world();
  const Earthwork earth = measure_earthwork(world, active.on_ground);
  out["bank_volume_m3"] = earth.bank_volume;
  out["loose_volume_m3"] = earth.loose_volume;
  for (std::size_t i = 0; i < earth.soils.size(); ++i)
    out["earthwork"].push_back({{"soil", world.description().soils[i].name},
                                {"dug_kg", earth.soils[i].dug},
                                {"spoil_kg", earth.soils[i].spoil}});
  if (const heightfield::DesignSurface* design = session.design())
    out["design"] = design_comparison(world, active, *design);
  const Score score = measure_score(session, active, earth);
  out["score"] = score_json(score, world.description());
  // Absent in a scene without goals.
  if (json goals = goal_list(judge(score, world.description().goals)); !goals.empty())
    out["goals"] = goals;
}

/// Adds energy, forces and the solver's counts to `out`.
void add_forces(const session::Session& session, json& out) {
  const sim::World& world = session.world();
  const sim::SoilCounts counts = world.soil().counts();
  // Sum over all machines.
  out["energy_j"] = session.energy();
  // Energy account of the active soil, if it was opened.
  if (const auto energy = world.soil().energy())
    out["soil_energy_j"] = soil_energy(*energy, nullptr);
  // Forces are evaluated in every step, not at the rate of telemetry.
  out["bucket_force_peak_n"] = session.force().peak;
  out["bucket_draft_peak_n"] = session.force().draft_peak;
  out["bucket_force_mean_n"] = session.force().mean();
  out["rock_force_peak_n"] = session.force().rock_peak;
  out["momentum_residual_max"] = session.force().residual_max;
  // Counts of the solver, e.g. to choose a device.
  out["particles_peak"] = counts.particles_peak;
  out["particle_steps"] = counts.particle_steps;
  out["shell_crossings"] = counts.shell_crossings;
  out["rebins"] = counts.rebins;
  out["activated_columns"] = counts.activated_columns;
  out["deposited_blocks"] = counts.deposited_blocks;
}

}  // namespace

/// The keys are an interface (docs/reference/results.md lists them): they may be added and never
/// renamed.
std::string summary_json(const session::Session& session, const RunStatus& status, bool with_hash) {
  const sim::World& world = session.world();
  // One pass over the particles serves all that follows.
  const sim::ActivePlaces active = sim::active_places(world);
  json out;
  // Scene, status and speed.
  out["schema_version"] = kSummarySchemaVersion;
  out["scenario"] = world.description().name;
  out["status"] = status.status;
  // Absent in a run without problems.
  if (!status.message.empty()) out["message"] = printable_lines(status.message);
  // Results are bit-identical on one device only.
  out["device"] = session.device_name();
  out["steps"] = world.steps();
  out["step_s"] = world.dt();
  out["wall_time_s"] = status.wall_time;
  out["render_time_s"] = status.render_time;
  out["encode_time_s"] = status.encode_time;
  out["simulated_time_s"] = world.time();
  // Counts the time that this process simulated, without pictures and files.
  out["real_time_factor"] =
      status.wall_time > 0 ? (world.time() - status.start_time) / status.wall_time : 0.0;
  out["time_share"] = time_shares(session, status);
  for (const auto& [stage, seconds] : world.soil().stage_times())
    out["soil_stage_s"][stage] = seconds;
  const device::DeviceTraffic traffic = device::traffic();
  out["device_traffic"] = {{"launches", traffic.launches},
                           {"waits", traffic.waits},
                           {"read_bytes", traffic.read_bytes},
                           {"written_bytes", traffic.written_bytes}};
  add_programs(session, status.status, out);
  add_ground(session, active, out);
  add_forces(session, out);
  out["frames"] = status.frames;
  out["mass_ledger"] = ledger(session, active);
  // Null while the run goes on, as the hash costs a pass over the state.
  out["state_hash"] = with_hash ? json(session.state_hash()) : json(nullptr);
  // A name that is not UTF-8 may come from a library's scene, and must not cost the summary.
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace navvy::record
