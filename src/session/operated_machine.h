// SPDX-License-Identifier: Apache-2.0
// A machine with its program: what its operator sees and commands. Private to the session.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "control/operator.h"
#include "core/archive.h"
#include "heightfield/terrain_view.h"
#include "session/bucket_gauge.h"
#include "session/reports.h"
#include "sim/world.h"

namespace navvy::session {

/// What an operator sees from its cab: columns and the loose soil on them. Takes one view in every
/// step in which it is asked, so it has no memory that a snapshot would need; one look costs a pass
/// over the particles.
class SeenSurface final : public control::SurfaceView {
 public:
  /// `world` must outlive it.
  explicit SeenSurface(const sim::World& world) : world_(world) {}
  const heightfield::Terrain& terrain() const override;
  /// A view of its own each time.
  heightfield::TerrainView mapped() const override;
  /// The next question takes a new view.
  void forget() { view_.reset(); }

 private:
  const sim::World& world_;
  mutable std::optional<heightfield::TerrainView> view_;
  mutable std::uint64_t seen_step_ = 0;
};

/// One machine's operator with the handles to look through, and the cycle and tip that are not over
/// yet.
class OperatedMachine {
 public:
  using Programs = std::map<std::string, control::ProgramProgress>;

  /// What operators see beside their own machine is shared; all references must outlive it.
  OperatedMachine(sim::World& world, int machine, const SeenSurface& surface,
                  const Programs& programs, const control::MakePathPlanner& planners);

  int index() const { return machine_.index(); }
  const std::string& name() const { return machine_.name(); }
  const control::Operator& op() const { return op_; }
  /// Driven by inputs: the program no longer commands.
  bool taken() const { return taken_; }
  /// The program goes on.
  bool busy() const { return !taken_ && !op_.ended(); }

  /// The operator looks and commands. Cycles and tips that end go into the lists. Nothing once the
  /// machine is taken.
  void step(std::vector<Cycle>& cycles, std::vector<BedTip>& tips);
  /// Inputs drive it from now on: what its program had set in motion stops. True the first time.
  bool take();
  /// How its program stands; looks at the surface where a step's account needs that.
  ProgramReport report() const;

  void visit(Archive& a);

 private:
  void observe(control::Observation& seen) const;
  void send(const control::Command& command);
  void note_cycle(std::vector<Cycle>& cycles);
  void note_tip(std::vector<BedTip>& tips);

  sim::World& world_;
  sim::MachineHandle machine_;
  std::vector<sim::JointHandle> joints_;
  std::vector<sim::WheelHandle> wheels_;
  std::optional<BucketGauge> bucket_;
  std::optional<sim::ToolHandle> bed_;
  // The operator's own memory is in it; what it saw last is beside it.
  control::Operator op_;
  control::Observation seen_;
  // Begun and not yet ended.
  std::optional<Cycle> open_;
  std::optional<BedTip> open_tip_;
  bool taken_ = false;
};

}  // namespace navvy::session
