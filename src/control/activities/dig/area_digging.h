// SPDX-License-Identifier: Apache-2.0
// The activity that carries out a dig_area step. Private to the dig.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control/activities/dig/dig.h"
#include "control/activities/dig/dig_area.h"
#include "control/activities/dig/truck_queue.h"
#include "control/activities/part.h"
#include "control/activity.h"
#include "control/job_planner.h"

namespace navvy::control {

/// State of a dig_area, except that of the part that runs.
struct AreaMemory {
  /// Stations as planned when the step began.
  std::vector<JobStation> stations;
  /// Index of the present station.
  std::int64_t station = 0;
  /// True if a cut was begun at the present station.
  bool working = false;
  /// Keys of cuts at the present station, one entry each time: of cuts that brought little, and of
  /// all strips that are levelled or belong to a heap.
  std::vector<std::int64_t> begun;
  /// Mass that the present cut has brought [kg], and number of cuts in a row that brought little.
  double brought = 0;
  std::int64_t poor = 0;
  /// The cut that runs.
  JobCut cut;
  /// Number of cuts made so far, and of those that failed.
  std::int64_t cuts = 0, failed = 0;
  /// Number of cycles of the program when the present cut began.
  std::int64_t cycles = 0;
  /// Volume that the hole lacked when a fill began [m3].
  double lacked = 0;
  /// Way of driving to a station.
  enum class Way : std::uint8_t {
    kNone,     ///< before the first drive
    kPlanned,  ///< along a planned path
    kAhead,    ///< straight ahead
    kBack      ///< straight back
  };
  /// The way to the present station.
  Way way = Way::kNone;
  /// True after the straight drive to the present station has failed.
  bool detour = false;
  /// Number of stations that could not be reached, and why the last one could not.
  std::int64_t missed = 0;
  std::string trouble;
  /// Time that the machine has waited for trucks in all, and since the last one [s].
  double waited = 0, waiting = 0;
  /// Dig::gain of the cuts.
  double gain = 1;
  /// True if the arm has been turned aside since the last cut, so that a truck can come.
  bool aside = false;

  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// Activity that carries out a dig_area: for each station tucks the arm in, drives there, and
/// makes the cuts that the job planner finds on the ground as it then is. Each of these is a part
/// with an activity of its own.
class AreaDigging final : public ActivityWith<AreaMemory> {
 public:
  /// Makes the activity of the step `step`. The step and `place` must outlive it; `place` must have
  /// an arm, a path planner and a job planner.
  AreaDigging(OperatorContext& place, const DigArea& step)
      : ActivityWith(place), step_(step), job_(step.job()), trucks_(step.into, step.load) {}
  ~AreaDigging() override;

  /// Plans the stations.
  void begin(const Observation& seen) override;
  /// Returns the name of the phase of the running part.
  const char* phase() const override;
  /// Returns the numbers of stations, of those that are done, of cuts and of failed ones, the
  /// commanded volume with what is left of it, and the loads of trucks.
  std::vector<Measurement> account(const Observation& seen) const override;
  /// Saves or loads the state and the running part.
  void visit(Archive& a) override;

 private:
  // Parts in the order in which a station is worked; the last two where trucks are loaded. No part
  // runs in kNext and kWait.
  enum Phase : std::int64_t { kNext, kTurn, kDrive, kCut, kTurnAside, kWait };

  /// Advances the running part. Returns true when the job is over.
  bool update(const Observation& seen, double dt, Command& out) override;
  /// Begins the next part. Returns true when there is none or the step has failed.
  bool go_on(const Observation& seen);
  /// Begins to wait for a truck, with the arm turned aside. Returns true when the step has failed.
  bool wait_for_truck(const Observation& seen);
  /// Begins to turn the arm ahead, out of the way of trucks. Always returns false.
  bool turn_aside(const Observation& seen);
  /// Selects the next cut at the present station; returns false if there is none.
  bool select_cut(const Observation& seen);
  /// Returns true if the present cut, which is over, brought less than a share of a load each time:
  /// a third, less where cuts are small.
  bool brought_little(const Observation& seen) const;
  /// Returns true if the machine stands at the pose.
  bool stands_at(const Observation& seen, const PlanePose& pose) const;
  /// Sets up the drive to the present station: straight if that leads there, else planned.
  void aim(const Observation& seen);
  /// Handles the end of the running part: a straight drive that failed is tried once along a
  /// planned path, then the station is left out; a cut that failed is left out.
  void end_part(const Observation& seen);
  /// Handles the end of a cut, which `failed` or not.
  void end_cut(const Observation& seen, bool failed, const std::string& reason);
  /// Goes on to the next station.
  void leave_station();
  /// Returns the volumes of the job on the ground as it is.
  JobVolume volume(const Observation& seen) const;
  /// Ends the step by what is left.
  bool conclude(const Observation& seen);
  /// Ends a step that has not made its loads. Always returns true.
  bool heap_is_empty(const Observation& seen);
  /// Returns the present station.
  const JobStation& station() const { return m.stations[static_cast<std::size_t>(m.station)]; }
  /// Makes step and activity of the part of the present phase, whose state is new.
  void make_part();
  /// Returns the step that makes the present cut.
  Dig cut_step();

  // The step that is carried out, and its job.
  const DigArea& step_;
  const PitJob job_;
  TruckQueue trucks_;
  Part part_;
};

}  // namespace navvy::control
