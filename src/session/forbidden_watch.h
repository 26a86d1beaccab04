// SPDX-License-Identifier: Apache-2.0
// Detects the events that a scene forbids.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "control/outcome.h"
#include "core/archive.h"
#include "session/collision.h"
#include "sim/world.h"

namespace navvy::session {

/// A forbidden event that has occurred.
struct ForbiddenEvent {
  /// Name of the event, as its element in <navvy:forbid>, such as "off_site".
  std::string event;
  /// Explanation with the names of the machines, as a sentence.
  std::string reason;
  /// Simulated time at which it was detected [s].
  double time = 0;

  /// Returns the event as one line of text.
  std::string text() const;
  /// Saves or loads all fields.
  void visit(Archive& a);
};

/// State of a machine with or without a program, as the watch needs it.
struct MachineOutcome {
  int machine = 0;                                          ///< index in scene::Scene::machines
  control::StepState state = control::StepState::kRunning;  ///< state of the machine
  std::string reason;                                       ///< explanation of the state
};

/// Compares a world with scene::Forbidden after each step and records the first forbidden event.
/// It changes nothing that a run computes. A scene that forbids nothing costs nothing.
class ForbiddenWatch {
 public:
  /// Reads the forbidden events of the scene of `world`.
  explicit ForbiddenWatch(const sim::World& world);

  /// Returns true if the scene forbids an event that depends on the states of machines.
  bool needs_states() const;
  /// Looks for a forbidden event, unless there was one already; logs the first. `states` holds the
  /// machines that have failed. `last` is true if no further step follows. Soil is measured twice
  /// per simulated second and at the last step, each time with a pass over the particles.
  void look(const sim::World& world, const CollisionWatch& collisions,
            const std::vector<MachineOutcome>& states, bool last);
  /// Returns the first forbidden event; empty if there was none.
  const std::optional<ForbiddenEvent>& event() const { return event_; }

  /// Saves or loads the event and the machines that started outside the site.
  void visit(Archive& a);

 private:
  /// Records and logs the event.
  void note(const sim::World& world, const char* event, const std::string& reason);
  /// Looks for a base that has left the site.
  void look_at_border(const sim::World& world);
  /// Looks for soil outside the areas.
  void look_at_soil(const sim::World& world);
  /// Returns true if a column lies in an area in which soil may rest.
  bool is_allowed(const sim::World& world, int ix, int iy);

  // Forbidden events of the scene.
  scene::Forbidden forbidden_;
  // The first forbidden event; empty if there was none.
  std::optional<ForbiddenEvent> event_;
  // By machine: 1 if its base was on the site when it was last seen there.
  std::vector<std::uint8_t> was_on_site_;
  // By column: 1 if soil may rest there; made at the first use. Not part of the state.
  std::vector<std::uint8_t> allowed_;
};

}  // namespace navvy::session
