// SPDX-License-Identifier: Apache-2.0
#include "record/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "control/dig_pose.h"
#include "heightfield/design_surface.h"
#include "record/column_changes.h"
#include "record/shape_score.h"

namespace navvy::record {
namespace {

/// Cycles whose machine has moved by more than this began another station [m].
constexpr double kSameStation = 0.5;
// Change of a column that counts as none, as a share of a cell: that of measure_earthwork.
constexpr double kRut = 0.05;

/// Returns the loose density of the dug soil, as a mean of the soils by their dug mass [kg/m3].
double loose_density(const std::vector<scene::Soil>& soils, const Earthwork& earth) {
  double mass = 0, volume = 0;
  for (std::size_t i = 0; i < soils.size(); ++i) {
    mass += earth.soils[i].dug;
    volume += earth.soils[i].dug * soils[i].swell / soils[i].bank_density;
  }
  return volume > 0 ? mass / volume : 0;
}

/// Returns the cycles of one machine by segment.
CycleScore cycle_score(const std::vector<session::Cycle>& cycles, double capacity, double density) {
  std::vector<double> dig, loaded, dump, empty, whole, payload, fill;
  for (std::size_t i = 0; i < cycles.size(); ++i) {
    const session::Cycle& one = cycles[i];
    dig.push_back(one.lift_out - one.start);
    loaded.push_back(one.dump_start - one.lift_out);
    dump.push_back(one.end - one.dump_start);
    payload.push_back(one.payload_dump);
    if (capacity * density > 0) fill.push_back(one.payload_dump / (capacity * density));
    // A drive to another place is no part of a cycle.
    if (i + 1 >= cycles.size() || (cycles[i + 1].place - one.place).norm() > kSameStation) continue;
    empty.push_back(cycles[i + 1].start - one.end);
    whole.push_back(cycles[i + 1].start - one.start);
  }
  return {spread_of(dig),   spread_of(loaded),  spread_of(dump), spread_of(empty),
          spread_of(whole), spread_of(payload), spread_of(fill)};
}

/// Returns the area that an arm reaches on level ground around its machine [m2].
double reach_area(const sim::World& world, const sim::MachineHandle& machine) {
  const scene::Arm& arm = machine.description().arm;
  if (arm.boom.empty() || arm.stick.empty() || arm.bucket.empty() ||
      machine.description().buckets.empty())
    return 0;
  const control::ArmKinematics kinematics(machine.description());
  const Pose X_WB = machine.link(0).pose();
  const Vec3 ring = (X_WB * kinematics.X_BS()).translation();
  const Vec2i column = world.ground().column_at(ring.x(), ring.y());
  const double ground = world.ground().start_height(column.x(), column.y());
  const control::TipReach reach = control::tip_reach(kinematics, ground - ring.z(), 0);
  const double near = std::max(control::kNearestDig, reach.least);
  return reach.most > near ? kPi * (reach.most * reach.most - near * near) : 0;
}

/// Returns the work of each machine that dug or drove.
std::vector<MachineScore> machine_scores(const session::Session& session, double density) {
  const sim::World& world = session.world();
  std::vector<MachineScore> out;
  for (int m = 0; m < world.machines().count(); ++m) {
    const sim::MachineHandle machine = world.machines().at(m);
    std::vector<session::Cycle> cycles;
    for (const session::Cycle& one : session.cycles())
      if (one.machine == m) cycles.push_back(one);
    const double distance = session.travel().machines()[static_cast<std::size_t>(m)].distance;
    if (cycles.empty() && distance == 0) continue;
    const auto& buckets = machine.description().buckets;
    MachineScore score{m, static_cast<int>(cycles.size()), {}, distance, 0, 0, machine.work()};
    if (!cycles.empty()) {
      score.cycle = cycle_score(cycles, buckets.empty() ? 0 : buckets[0].capacity, density);
      score.reach_area = reach_area(world, machine);
      score.stations = 1;
      for (std::size_t i = 1; i < cycles.size(); ++i)
        score.stations += (cycles[i].place - cycles[i - 1].place).norm() > kSameStation ? 1 : 0;
    }
    out.push_back(score);
  }
  return out;
}

/// Returns the time at which the last program ended; the present time if one has not.
double work_time(const session::Session& session) {
  double end = 0;
  bool any = false;
  for (const session::ProgramReport& report : session.programs()) {
    if (report.steps == 0) continue;
    any = true;
    end = std::max(end, report.last().end);
  }
  return any ? end : session.world().time();
}

/// Adds the masses of all changed columns, and the volumes of ruts, to their areas, and compares
/// the masses with the ledger.
void add_masses(const session::Session& session, const heightfield::Terrain& surface,
                const sim::ActivePlaces& active, Score& out) {
  const sim::World& world = session.world();
  const heightfield::DesignSurface* design = session.design();
  const std::size_t soils = world.ground().setup().soils.size();
  std::vector<std::int64_t> sum(soils, 0);
  const double square = surface.cell() * surface.cell();
  for_each_changed_column(world, active.on_ground, [&](const ColumnChange& column) {
    AreaScore& area =
        design != nullptr && has_design(*design, column.ix, column.iy) ? out.inside : out.outside;
    double volume = 0;  // gained, in bank state
    for (std::size_t i = 0; i < soils; ++i) {
      sum[i] += column.gain[i];
      (column.gain[i] < 0 ? area.lost : area.gained) += std::abs(column.gain[i]);
      volume += kilograms(column.gain[i]) / world.ground().setup().soils[i].bank_density;
    }
    if (std::abs(volume) > kRut * square * surface.cell()) return;
    const double rise =
        surface.height(column.ix, column.iy) - surface.start_height(column.ix, column.iy);
    (rise < 0 ? area.rut_cut : area.rut_fill) += std::abs(rise) * square;
  });
  // Soil that columns lost is in tools, in the air or beyond the border; nothing else may be.
  const sim::MassLedger ledger = world.soil().mass_ledger();
  for (std::size_t i = 0; i < soils; ++i)
    out.balance_error += std::abs(sum[i] + active.held[i] + active.elsewhere[i] +
                                  ledger.left_site[i] - ledger.inserted[i]);
}

/// Returns the loads of trucks by the accounts of all steps.
std::optional<LoadScore> load_score(const std::vector<session::ProgramReport>& programs) {
  std::optional<LoadScore> out;
  for (const session::ProgramReport& program : programs)
    for (const control::StepReport& step : program.list)
      for (const control::Measurement& one : step.measurements) {
        if (one.name == "loads") {
          if (!out) out.emplace();
          out->count += static_cast<int>(one.value);
        } else if (out && one.name == "load_error") {
          out->error = std::max(out->error, one.value);
        } else if (out && one.name == "load_offset_m") {
          out->offset = std::max(out->offset, one.value);
        } else if (out && one.name == "most_passes") {
          out->passes = std::max(out->passes, static_cast<int>(one.value));
        } else if (out && one.name == "spilt_kg") {
          out->spilt += one.value;
        }
      }
  return out;
}

/// Returns the judgement of a goal about loads, of which `bound` is the largest value.
GoalResult judge_loads(const char* name, const Score& score, double value, double bound) {
  GoalResult out{name, std::nullopt, bound, false, false, ""};
  if (score.loads && score.loads->count > 0) {
    out.value = value;
    out.met = value <= bound;
  } else {
    out.reason = "cannot be measured, as no truck was loaded";
  }
  return out;
}

/// Returns the judgement of the angle of the sides, of which `bound` [rad] is the largest error. An
/// angle that cannot be measured misses the goal: nothing shows that the sides are as commanded.
GoalResult judge_batter(const ShapeScore& shape, double bound) {
  GoalResult out;
  out.name = "batter_error_deg";
  out.bound = degrees(bound);
  if (!shape.batter || !shape.design_batter) {
    out.reason = "cannot be measured, as fewer than 20 columns show the angle of the sides";
    return out;
  }
  const double error = std::abs(*shape.batter - *shape.design_batter);
  out.value = degrees(error);
  out.met = error <= bound;
  return out;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

}  // namespace

Spread spread_of(const std::vector<double>& values) {
  Spread out;
  out.count = static_cast<int>(values.size());
  if (values.empty()) return out;
  for (const double one : values) out.mean += one / out.count;
  for (const double one : values) out.spread += (one - out.mean) * (one - out.mean);
  out.spread = out.count > 1 ? std::sqrt(out.spread / (out.count - 1)) : 0;
  return out;
}

Score measure_score(const session::Session& session, const sim::ActivePlaces& active,
                    const Earthwork& earth) {
  const sim::World& world = session.world();
  Score out;
  const heightfield::TerrainView surface =
      world.ground().view(world.time()).with(active.on_ground, heightfield::SurfaceKind::kMapped);
  const heightfield::DesignSurface* design = session.design();
  add_volumes(surface, changed_rect(world.ground(), active.on_ground), design, out.inside,
              out.outside);
  if (design != nullptr) out.shape = measure_shape(surface, *design);
  add_masses(session, surface, active, out);
  out.loads = load_score(session.programs());
  out.bank_volume = earth.bank_volume;
  for (const session::Cycle& one : session.cycles()) out.moved += one.payload_dump;
  out.work_time = work_time(session);
  out.energy = session.energy();
  out.collisions = session.collisions().count();
  out.machines = machine_scores(session, loose_density(world.ground().setup().soils, earth));
  for (const MachineScore& one : out.machines) {
    if (one.cycles == 0) continue;
    out.stations += one.stations;
    out.reach_area += one.stations * one.reach_area;
    out.base_moves += one.distance;
  }
  return out;
}

Score measure_score(const session::Session& session) {
  const sim::ActivePlaces active = sim::active_places(session.world());
  return measure_score(session, active, measure_earthwork(session.world(), active.on_ground));
}

std::string GoalResult::text() const {
  return name + " " + (value ? "is " + number(*value) : reason) + ", wanted is " +
         (at_least ? "at least " : "at most ") + number(bound);
}

std::vector<GoalResult> judge(const Score& score, const scene::Goals& goals) {
  std::vector<GoalResult> out;
  const auto add = [&](const char* name, const scene::Goal& goal, double value, bool at_least) {
    if (!goal.given) return;
    const bool met = at_least ? value >= goal.value : value <= goal.value;
    out.push_back({name, value, goal.value, at_least, met, ""});
  };
  const ShapeScore shape = score.shape.value_or(ShapeScore{});
  add("completion", goals.completion, shape.completion, true);
  add("coverage", goals.coverage, shape.coverage, true);
  add("volume_error", goals.volume_error, std::abs(shape.volume_error), false);
  add("rms_error_m", goals.rms_error, shape.rms, false);
  add("over_dig_rms_m", goals.over_dig_rms, shape.over_rms, false);
  add("over_dig_max_m", goals.over_dig_max, shape.over_max, false);
  add("under_dig_rms_m", goals.under_dig_rms, shape.under_rms, false);
  if (goals.batter_error.given) out.push_back(judge_batter(shape, goals.batter_error.value));
  add("outside_cut_m3", goals.outside_cut, score.outside.cut, false);
  add("collisions", goals.collisions, static_cast<double>(score.collisions), false);
  add("work_time_s", goals.work_time, score.work_time, false);
  const LoadScore loads = score.loads.value_or(LoadScore{});
  if (goals.load_error.given)
    out.push_back(judge_loads("load_error", score, loads.error, goals.load_error.value));
  if (goals.load_passes.given)
    out.push_back(judge_loads("load_passes", score, loads.passes, goals.load_passes.value));
  if (goals.spilt.given)
    out.push_back(judge_loads("spilt_kg", score, loads.spilt, goals.spilt.value));
  return out;
}

}  // namespace navvy::record
