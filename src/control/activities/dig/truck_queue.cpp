// SPDX-License-Identifier: Apache-2.0
#include "control/activities/dig/truck_queue.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "control/activities/dig/landing.h"
#include "control/activities/dig/seen_surface.h"
#include "control/activity.h"
#include "control/dig_pose.h"
#include "control/reach.h"

namespace navvy::control {
namespace {

constexpr double kStands = 0.05;   // speed of a machine that stands [m/s]
constexpr double kMoved = 0.4;     // distance by which it may creep while it is loaded [m]
constexpr double kOverRim = 0.3;   // clearance of the bucket's tip over a rim [m]
constexpr double kSpread = 0.5;    // part of a bed over which its load is spread
constexpr double kShorter = 0.03;  // by which a dump may be lower than asked for [m]

/// Returns true if the bucket can be opened at `p`, `height` [m] above the ground there.
bool reaches(const Observation& seen, const ArmKinematics& arm, const Vec2& p, double height) {
  const double ground =
      with_surface(seen, [&](const SurfaceView& surface) { return heap_height(surface, p); });
  ArmAngles q;
  double possible = 0;
  return dump_pose(arm, seen.X_WB * arm.X_BS(), p, ground, height, q, possible) &&
         possible > height - kShorter;
}

}  // namespace

Vec2 TruckQueue::spread() const { return kSpread * to_end_; }

bool TruckQueue::reaches_bed(const Observation& seen, const ArmKinematics& arm) const {
  return reaches(seen, arm, middle_ + spread(), height_) &&
         reaches(seen, arm, middle_ - spread(), height_);
}

void TruckQueue::release(const Observation& seen, double load) {
  const std::optional<BedView> bed = seen.bed_of ? seen.bed_of(name()) : std::nullopt;
  const std::optional<Vec2> centre =
      seen.load_centre_of ? seen.load_centre_of(name()) : std::nullopt;
  if (bed && centre) offset_ = std::max(offset_, (*centre - bed->middle).norm());
  loaded_.push_back(load - before_);
  most_passes_ = std::max(most_passes_, passes_);
  passes_ = 0;
  last_ = chosen_;
  chosen_ = -1;
}

void TruckQueue::count_pass(double mass) {
  ++passes_;
  dumped_ += mass;
}

bool TruckQueue::look(const Observation& seen, const OperatorContext& place, double dump_height) {
  if (!seen.bed_of) return false;
  if (chosen_ >= 0) {
    const std::optional<BedView> bed = seen.bed_of(name());
    const double load = bed ? bed->load : before_;
    const bool full = is_loaded(load, load_);
    if (bed && !full && (bed->middle - middle_).norm() <= kMoved && reaches_bed(seen, *place.arm))
      return true;
    if (full)
      place.note("'" + name() + "' is loaded with " + number_text(load, "kg"));
    else
      place.warn("goes on without '" + name() + "', which has " + number_text(load, "kg") + " of " +
                 number_text(load_, "kg"));
    error_ = std::max(error_, std::abs(load / load_ - 1));
    release(seen, load);
  }
  const auto n = static_cast<std::int64_t>(names_.size());
  for (std::int64_t k = 1; k <= n; ++k) {
    const std::int64_t i = (last_ + k) % n;
    const std::optional<BedView> bed = seen.bed_of(names_[static_cast<std::size_t>(i)]);
    if (!bed || bed->speed > kStands || is_loaded(bed->load, load_)) continue;
    const double ground = with_surface(seen, [&](const SurfaceView& surface) {
      return surface.height(bed->middle.x(), bed->middle.y());
    });
    middle_ = bed->middle;
    to_end_ = bed->to_end;
    height_ = std::max(dump_height, bed->rim - ground + kOverRim);
    if (!reaches_bed(seen, *place.arm)) continue;
    chosen_ = i;
    before_ = bed->load;
    return true;
  }
  return false;
}

void TruckQueue::end(const Observation& seen) {
  if (chosen_ >= 0 && seen.load_of) release(seen, seen.load_of(name()));
}

bool TruckQueue::is_full(const Observation& seen) const {
  return chosen_ >= 0 && seen.load_of && is_loaded(seen.load_of(name()), load_);
}

std::string TruckQueue::text(const Observation& seen) const {
  std::string out;
  for (const std::string& one : names_) {
    const std::optional<BedView> bed = seen.bed_of ? seen.bed_of(one) : std::nullopt;
    out += (out.empty() ? "'" : ", '") + one + "' ";
    out += bed ? (bed->speed > kStands ? "drives at " : "stands at ") + place_text(bed->middle) +
                     " with " + number_text(bed->load, "kg")
               : "has no bed";
  }
  return out;
}

std::vector<Measurement> TruckQueue::account(const Observation& seen) const {
  if (names_.empty()) return {};
  double sum = std::accumulate(loaded_.begin(), loaded_.end(), 0.0);
  if (chosen_ >= 0 && seen.load_of) sum += seen.load_of(name()) - before_;
  std::vector<Measurement> out = {{"loads", static_cast<double>(loads())},
                                  {"loaded_kg", sum},
                                  {"load_error", error_},
                                  {"load_offset_m", offset_},
                                  {"most_passes", static_cast<double>(most_passes_)},
                                  {"spilt_kg", dumped_ - sum}};
  for (std::size_t i = 0; i < loaded_.size(); ++i)
    out.push_back({"load_" + std::to_string(i + 1) + "_kg", loaded_[i]});
  return out;
}

void TruckQueue::visit(Archive& a) {
  // Jobs without trucks keep their states.
  if (names_.empty()) return;
  const auto n = static_cast<std::int64_t>(names_.size());
  a("chosen", chosen_);
  a("last", last_);
  a.require(chosen_ >= -1 && chosen_ < n && last_ >= -1 && last_ < n, "chosen",
            "the job has no such truck");
  a("middle", middle_);
  a("to_end", to_end_);
  a("height", height_);
  a("before", before_);
  a("loaded", loaded_);
  a("error", error_);
  a("offset", offset_);
  a("dumped", dumped_);
  a("passes", passes_);
  a("most_passes", most_passes_);
}

}  // namespace navvy::control
