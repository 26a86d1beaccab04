// SPDX-License-Identifier: Apache-2.0
// A pit from several stations: tuck the arm in, drive to a station, make its cuts, and so on.
#include "control/activities/dig/area_digging.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "control/activities/dig/fill.h"
#include "control/activities/dig/seen_surface.h"
#include "control/activities/drive_to.h"
#include "control/activities/go_to.h"
#include "control/activities/swing.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

// Tolerances of a station: cuts are planned from where the machine stands, so it need not be met
// exactly [m], [rad].
constexpr double kAtStation = 0.3, kAtHeading = radians(6);
// A drive is straight if the target is so little aside of the machine's axis [m] and its heading
// differs by so little [rad].
constexpr double kAside = 0.4, kTurned = radians(6);
// A cut that brings little is begun at most so often at one station: soil falls back into some. A
// strip is levelled at most so often: a full bucket leaves the rest of it.
constexpr int kMostRepeats = 3, kMostPasses = 3;
// Share of a heaped bucket that is little; after so many such cuts in a row a station is dug. A
// strip is not levelled again, nor a strip of a heap asked again, after a pass that brought less
// than the other share.
constexpr double kLittle = 0.3, kLevelled = 0.08;
constexpr int kMostPoor = 6;
// A strip of a heap gives at most so many scoops to one station.
constexpr int kMostScoops = 12;
// Share of the commanded volume: with more left, the pit is not done, as for a trench.
constexpr double kUndone = 0.15;
// The machine looks for a truck so often [s]: a look costs a pass over the particles.
constexpr double kLookEvery = 0.5;
// A levelled floor may deviate so many tolerances from its design.
constexpr double kUneven = 2;

}  // namespace

void AreaMemory::visit(Archive& a) {
  a("stations", stations);
  a("station", station);
  a.require(station >= 0 && station <= static_cast<std::int64_t>(stations.size()), "station",
            "the job has no such station");
  a("working", working);
  a("begun", begun);
  a("brought", brought);
  a("poor", poor);
  a("cut", cut);
  a("cuts", cuts);
  a("failed", failed);
  a.ranged("way", way, Way::kNone, Way::kBack);
  a("detour", detour);
  a("missed", missed);
  a("trouble", trouble);
  a("lacked", lacked);
  a("cycles", cycles);
  a("waited", waited);
  a("waiting", waiting);
  a("aside", aside);
  a("gain", gain);
}

AreaDigging::~AreaDigging() = default;

void AreaDigging::begin(const Observation& seen) {
  const JobPlan plan = with_surface(seen, [&](const SurfaceView& surface) {
    return place_.jobs->plan(job_, seen.X_WB, surface);
  });
  m.stations = plan.stations;
  m.lacked = plan.volume;
  enter(kNext);
}

bool AreaDigging::stands_at(const Observation& seen, const PlanePose& pose) const {
  const PlanePose at = plane_pose(seen.X_WB);
  return (at.p - pose.p).norm() <= kAtStation &&
         std::abs(std::remainder(at.yaw - pose.yaw, 2 * kPi)) <= kAtHeading;
}

void AreaDigging::aim(const Observation& seen) {
  using Way = AreaMemory::Way;
  const PlanePose at = plane_pose(seen.X_WB), &to = station().at;
  const Vec2 ahead(std::cos(at.yaw), std::sin(at.yaw)), across(-ahead.y(), ahead.x());
  const Vec2 line = to.p - at.p;
  const bool straight = !m.detour && std::abs(line.dot(across)) <= kAside &&
                        std::abs(std::remainder(at.yaw - to.yaw, 2 * kPi)) <= kTurned;
  m.way = !straight ? Way::kPlanned : line.dot(ahead) >= 0 ? Way::kAhead : Way::kBack;
}

void AreaDigging::make_part() {
  std::unique_ptr<ActivityStep> part;
  if (phase_index() == kTurn) {
    auto step = std::make_unique<Swing>(0);
    step->tucks = true;
    part = std::move(step);
  } else if (phase_index() == kDrive && m.way == AreaMemory::Way::kPlanned) {
    auto step = std::make_unique<GoTo>();
    step->target = station().at.p;
    step->heading = station().at.yaw;
    step->speed = step_.speed;
    step->tolerance = kAtStation;
    part = std::move(step);
  } else if (phase_index() == kDrive) {
    auto step = std::make_unique<DriveTo>();
    step->target = station().at.p;
    step->heading = station().at.yaw;
    step->has_heading = true;
    step->speed = m.way == AreaMemory::Way::kAhead ? step_.speed : -step_.speed;
    step->tolerance = kAtStation;
    part = std::move(step);
  } else if (phase_index() == kTurnAside) {
    part = std::make_unique<Swing>(0);
  } else {
    part = std::make_unique<Dig>(cut_step());
  }
  part_.make(std::move(part), place_);
}

Dig AreaDigging::cut_step() {
  Dig step;
  step.from = m.cut.near;
  step.to = m.cut.far;
  step.floor = m.cut.floor;
  step.rim = m.cut.rim;
  step.width = place_.arm->bucket().width;
  step.depth = job_.pass_depth;
  step.levels = m.cut.levels;
  step.worth = m.cut.worth;
  // One layer is one slice, also where the ground is higher than it was. For a stated mass the
  // slices of a heap are thin, or the curl brings far more than was aimed at.
  step.pass_depth = (job_.heap && job_.into_beds ? 1 : 2) * job_.pass_depth;
  step.dump_at = m.cut.dump_at;
  step.dump_height = step_.dump_height;
  step.fill = step_.fill;
  step.has_fill = step_.has_fill;
  if (m.cut.fill > 0) {
    // One scoop, no larger than the hollow that it fills.
    step.max_cycles = 1;
    step.has_fill = step_.has_fill || m.cut.fill < 1;
    step.fill = std::min(step_.has_fill ? step_.fill : 1.0, m.cut.fill);
  }
  if (job_.into_beds) {
    step.into = trucks_.name();
    step.has_into = step.has_load = true;
    step.load = step_.load;
    step.gain = &m.gain;
    step.dump_at = trucks_.middle();
    step.spread = trucks_.spread();
    step.dump_height = trucks_.height();
  }
  return step;
}

bool AreaDigging::select_cut(const Observation& seen) {
  const std::vector<JobCut> cuts = with_surface(seen, [&](const SurfaceView& surface) {
    return place_.jobs->cuts(job_, seen.X_WB, surface);
  });
  if (!cuts.empty() && !cuts.front().has_dump_at && !job_.into_beds) {
    m.trouble = "at station " + std::to_string(m.station + 1) +
                " the spoil is too high for the bucket to open over it anywhere within reach";
    place_.warn(m.trouble);
    return false;
  }
  for (const JobCut& cut : cuts) {
    const int most = cut.levels ? kMostPasses : cut.fill > 0 ? kMostScoops : kMostRepeats;
    if (std::count(m.begun.begin(), m.begun.end(), cut.key) >= most) continue;
    if (!cut.levels && m.poor >= kMostPoor) continue;
    m.working = true;
    m.brought = 0;
    if (cut.levels || cut.fill > 0) m.begun.push_back(cut.key);
    m.cut = cut;
    m.cycles = place_.handover.cycles;
    ++m.cuts;
    return true;
  }
  return false;
}

bool AreaDigging::go_on(const Observation& seen) {
  const auto stations = static_cast<std::int64_t>(m.stations.size());
  if (m.station >= stations) {
    // A bucket over the bed would keep the truck from leaving.
    if (job_.into_beds && place_.handover.is_out) return turn_aside(seen);
    return conclude(seen);
  }
  // A cut that was begun here means that the machine has arrived, wherever digging has moved it.
  if (!m.working && phase_index() != kDrive && !stands_at(seen, station().at)) {
    // The arm points ahead while the machine drives.
    enter(phase_index() == kTurn ? kDrive : kTurn);
    if (phase_index() == kDrive) aim(seen);
  } else if (job_.into_beds && !trucks_.look(seen, place_, step_.dump_height)) {
    return wait_for_truck(seen);
  } else if (select_cut(seen)) {
    m.aside = false;
    m.waiting = 0;
    enter(kCut);
  } else {
    leave_station();
    return false;
  }
  make_part();
  part_->begin(seen);
  return false;
}

bool AreaDigging::wait_for_truck(const Observation& seen) {
  if (step_.loads && trucks_.loads() >= *step_.loads) {
    m.station = static_cast<std::int64_t>(m.stations.size());
    return false;
  }
  if (m.waiting >= step_.longest)
    return Activity::fall_short(
        StepState::kOutOfTime,
        "no truck to load came within " + number_text(m.waiting, "s") + ": " + trucks_.text(seen));
  if (m.aside) {
    enter(kWait);
    return false;
  }
  return turn_aside(seen);
}

bool AreaDigging::turn_aside(const Observation& seen) {
  m.aside = true;
  enter(kTurnAside);
  make_part();
  part_->begin(seen);
  return false;
}

void AreaDigging::leave_station() {
  ++m.station;
  m.begun.clear();
  m.working = false;
  m.poor = 0;
  m.detour = false;
  enter(kNext);
}

bool AreaDigging::brought_little(const Observation& seen) const {
  const auto cycles = static_cast<double>(place_.handover.cycles - m.cycles);
  const scene::Soil soil = surface_soil(*seen.ground, 0.5 * (m.cut.near + m.cut.far));
  const double full = place_.arm->bucket().capacity / soil.swell * soil.bank_density;
  const double little = m.cut.levels || m.cut.fill > 0 ? kLevelled
                        : m.cut.worth > 0              ? std::min(kLittle, m.cut.worth)
                                                       : kLittle;
  return m.brought <= little * cycles * full;
}

void AreaDigging::end_cut(const Observation& seen, bool failed, const std::string& reason) {
  if (m.cut.fill > 0) {
    if (failed || m.cycles == place_.handover.cycles || brought_little(seen))
      m.begun.insert(m.begun.end(), kMostScoops, m.cut.key);
  } else if (m.cut.levels) {
    if (brought_little(seen)) m.begun.insert(m.begun.end(), kMostPasses, m.cut.key);
  } else if (!trucks_.is_full(seen)) {
    const bool little = failed || brought_little(seen);
    if (little) m.begun.push_back(m.cut.key);
    m.poor = little ? m.poor + 1 : 0;
  }
  if (!failed) return;
  // Another cut may do, and what is left decides in the end.
  ++m.failed;
  place_.warn("the cut from " + place_text(m.cut.far) + " to " + place_text(m.cut.near) +
              " is left: " + reason);
}

void AreaDigging::end_part(const Observation& seen) {
  const bool failed = fell_short(part_->state());
  const std::string reason = part_->reason();
  part_.clear();
  if (phase_index() == kCut) return end_cut(seen, failed, reason);
  if (!failed) return;
  if (phase_index() == kTurnAside) return place_.warn("a truck has little space: " + reason);
  const std::string where =
      "station " + std::to_string(m.station + 1) + " of " + std::to_string(m.stations.size());
  if (phase_index() == kDrive && m.way != AreaMemory::Way::kPlanned) {
    place_.warn("the straight drive to " + where + " failed, it plans a path: " + reason);
    m.detour = true;
    enter(kNext);
    return;
  }
  ++m.missed;
  m.trouble = where + " was not reached: " + reason;
  place_.warn(m.trouble);
  leave_station();
}

bool AreaDigging::update(const Observation& seen, double dt, Command& out) {
  if (part_) {
    const bool over = part_->advance(seen, dt, out);
    if (const CycleEvent event = part_->take_event(); event != CycleEvent::kNone) {
      if (event == CycleEvent::kDumpStart) m.brought += seen.payload;
      if (event == CycleEvent::kDumpStart && job_.into_beds) trucks_.count_pass(seen.payload);
      tell(event);
    }
    if (over) end_part(seen);
    return false;
  }
  if (phase_index() == kWait) {
    m.waited += dt;
    m.waiting += dt;
    if (phase_time() < kLookEvery) return false;
  }
  return go_on(seen);
}

JobVolume AreaDigging::volume(const Observation& seen) const {
  JobVolume out = with_surface(
      seen, [&](const SurfaceView& surface) { return place_.jobs->volume(job_, surface); });
  if (job_.heap) out.design = m.lacked;
  return out;
}

bool AreaDigging::conclude(const Observation& seen) {
  const bool loaded = step_.loads && trucks_.loads() >= *step_.loads;
  trucks_.end(seen);
  if (step_.loads) return loaded || heap_is_empty(seen);
  const JobVolume volume = this->volume(seen);
  const bool dug = volume.left <= kUndone * volume.design;
  if (dug && (job_.tolerance == 0 || volume.rms <= kUneven * job_.tolerance)) return true;
  if (dug)
    return Activity::fall_short(
        StepState::kBlocked, "the ground still deviates from the design by " + metres(volume.rms) +
                                 " (rms), more than twice the tolerance" +
                                 (m.trouble.empty() ? "" : "; " + m.trouble));
  return Activity::fall_short(StepState::kBlocked, std::string("what is left could not be ") +
                                                       (job_.heap ? "filled: " : "dug: ") +
                                                       number_text(volume.left, "m3") + " of " +
                                                       number_text(volume.design, "m3") +
                                                       (m.trouble.empty() ? "" : "; " + m.trouble));
}

bool AreaDigging::heap_is_empty(const Observation& seen) {
  return Activity::fall_short(StepState::kBlocked, "the heap gives no more soil for load " +
                                                       std::to_string(trucks_.loads()) + " of " +
                                                       std::to_string(*step_.loads) + ": " +
                                                       trucks_.text(seen));
}

const char* AreaDigging::phase() const {
  if (part_) return part_->phase();
  if (phase_index() == kWait) return "wait";
  return "plan";
}

std::vector<Measurement> AreaDigging::account(const Observation& seen) const {
  const JobVolume volume = this->volume(seen);
  std::vector<Measurement> out = {{"stations", static_cast<double>(m.stations.size())},
                                  {"stations_done", static_cast<double>(m.station - m.missed)},
                                  {"stations_missed", static_cast<double>(m.missed)},
                                  {"cuts", static_cast<double>(m.cuts)},
                                  {"cuts_failed", static_cast<double>(m.failed)},
                                  {"design_volume_m3", volume.design},
                                  {"volume_left_m3", volume.left},
                                  {"deviation_rms_m", volume.rms}};
  if (!job_.into_beds) return out;
  out.push_back({"waited_s", m.waited});
  const std::vector<Measurement> loads = trucks_.account(seen);
  out.insert(out.end(), loads.begin(), loads.end());
  return out;
}

void AreaDigging::visit(Archive& a) {
  ActivityWith::visit(a);
  a.require(phase_index() >= kNext && phase_index() <= kWait, "phase", "no phase of a dig_area");
  trucks_.visit(a);
  a.require(!job_.into_beds || phase_index() != kCut || trucks_.is_chosen(), "phase",
            "soil is dug for no truck");
  part_.visit(a, [&] {
    a.require(phase_index() != kNext && phase_index() != kWait, "running",
              "no part runs in this phase");
    // All other parts are made for the present station.
    a.require(
        phase_index() == kTurnAside || m.station < static_cast<std::int64_t>(m.stations.size()),
        "station", "a part runs, but all stations are done");
    make_part();
  });
}

}  // namespace navvy::control
