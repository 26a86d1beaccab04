// SPDX-License-Identifier: Apache-2.0
// The machines whose beds a job fills, one after the other. Private to the dig.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "control/arm_kinematics.h"
#include "control/observation.h"
#include "control/outcome.h"
#include "core/archive.h"

namespace navvy::control {

struct OperatorContext;

/// Chooses the machine into whose bed a job dumps: one that stands within the arm's reach and lacks
/// soil. It stays chosen until it is loaded or drives away; the next one is looked for after it in
/// the order of the names.
class TruckQueue {
 public:
  /// Takes the names of the machines and the mass to which each is loaded [kg]. Without names there
  /// is no queue.
  TruckQueue(const std::vector<std::string>& names, double load) : names_(names), load_(load) {}

  /// Looks where the machines stand, with `place` for messages. The arm must be able to open its
  /// bucket over the bed, at least `dump_height` [m] above the ground. Returns true if one is
  /// chosen.
  bool look(const Observation& seen, const OperatorContext& place, double dump_height);
  /// Returns true if a machine is chosen.
  bool is_chosen() const { return chosen_ >= 0; }
  /// Returns the name of the chosen machine; requires one.
  const std::string& name() const { return names_[static_cast<std::size_t>(chosen_)]; }
  /// Returns the middle of its bed in W when it was chosen [m].
  const Vec2& middle() const { return middle_; }
  /// Returns half of the line along its bed over which the passes are spread, in W [m].
  Vec2 spread() const;
  /// Returns the height above the ground under it from which the bucket clears its rim [m].
  double height() const { return height_; }
  /// Returns true if the chosen machine has its load.
  bool is_full(const Observation& seen) const;
  /// Ends the choice when the job is over.
  void end(const Observation& seen);
  /// Returns the number of machines that were loaded.
  std::int64_t loads() const { return static_cast<std::int64_t>(loaded_.size()); }
  /// Returns where each machine stands, and with what load, for a message.
  std::string text(const Observation& seen) const;
  /// Counts a pass into the chosen machine, of which the bucket held `mass` [kg].
  void count_pass(double mass);
  /// Returns the number of loads, their masses and their sum; the largest difference of a load from
  /// the wanted one, relative to it; the largest distance of a load's centre from the middle of its
  /// bed; the most passes of a load; and the mass that fell beside.
  std::vector<Measurement> account(const Observation& seen) const;

  /// Saves or loads the choice and the loads.
  void visit(Archive& a);

 private:
  /// Returns true if the bucket can be opened over both ends of the line along the bed.
  bool reaches_bed(const Observation& seen, const ArmKinematics& arm) const;
  /// Ends the choice of the present machine, whose beds hold `load` [kg].
  void release(const Observation& seen, double load);

  const std::vector<std::string>& names_;
  const double load_;
  std::int64_t chosen_ = -1, last_ = -1;  ///< indices of names; -1: none
  // Of the bed that was looked at last: the chosen one.
  Vec2 middle_ = Vec2::Zero(), to_end_ = Vec2::Zero();
  double height_ = 0;
  double before_ = 0;           ///< load of the chosen machine when it was chosen [kg]
  std::vector<double> loaded_;  ///< mass that each machine was given [kg]
  double error_ = 0;            ///< largest |load / wanted load - 1| of machines that left [-]
  double offset_ = 0;           ///< largest distance of a load's centre from its bed's middle [m]
  double dumped_ = 0;           ///< mass that the bucket held over beds, in all [kg]
  std::int64_t passes_ = 0, most_passes_ = 0;  ///< of the present load, and of any
};

}  // namespace navvy::control
