// SPDX-License-Identifier: Apache-2.0
// The program of a machine, step by step. The types of steps are defined in the module control.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/limits.h"
#include "scene/design.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Condition of a step that waits until another machine's program has completed some steps.
struct Waiting {
  std::string machine;  ///< name of the other machine
  int steps = 0;  ///< number of steps of the other machine that must be completed; 0: all its steps
};

/// One step of a program as described by the scene. The values are constant after the scene has
/// been read.
class Step {
 public:
  virtual ~Step() = default;
  /// Returns the name of the step's element in a scene file, e.g. "drive_to".
  virtual const char* element() const = 0;
  /// Passes the fields of the step to the visitor `f`.
  virtual void describe(Fields& f) = 0;
  /// Returns the condition that must hold before the step can finish; nothing if it does not wait
  /// for another machine. The loader refuses programs that wait for each other in a circle.
  virtual std::optional<Waiting> waits_for() const { return std::nullopt; }
  /// Returns the name of the machine's hitch that the step opens; nothing if it opens none.
  virtual std::optional<std::string> opens() const { return std::nullopt; }
  /// Returns the pit or pad that the step makes; nothing if it makes none. The score of a run
  /// compares the ground with it if the scene has no design surface.
  virtual std::optional<DesignArea> area() const { return std::nullopt; }
  /// Returns the points (x, y) in W at which the step works [m]: its targets, digs and dumps.
  virtual std::vector<Vec2> places() const { return {}; }

 protected:
  Step() = default;
  Step(const Step&) = default;
  Step& operator=(const Step&) = default;
};

/// A step of any type, handled as a value. Copies share the same description.
class ProgramStep {
 public:
  /// Wraps a step of the type T.
  template <class T, class = std::enable_if_t<std::is_base_of_v<Step, T>>>
  ProgramStep(T step) : step_(std::make_shared<T>(std::move(step))) {}  // NOLINT: implicit

  /// Returns the step.
  const Step& operator*() const { return *step_; }
  /// Returns the step.
  const Step* operator->() const { return step_.get(); }
  /// Visits the fields of the step; `f` must not write to them.
  void describe(Fields& f) const { step_->describe(f); }
  /// Returns the step if it is of the type T, otherwise null.
  template <class T>
  const T* as() const {
    return dynamic_cast<const T*>(step_.get());
  }

 private:
  std::shared_ptr<Step> step_;  ///< the step, shared by all copies
};

/// The steps of one machine's program, in the order of execution.
struct Program {
  std::vector<ProgramStep> steps;  ///< the steps
  /// Line in the scene file of each step, for messages; empty for a program that was not read from
  /// a file.
  std::vector<int> lines;

  /// Passes the steps and their fields to the visitor `f`.
  void describe(Fields& f) {
    List list{"step", {}, limits::kSteps, {}, steps.size(), {}, {}, {}};
    list.item = [this](std::size_t i, Fields& g) {
      g.derived_text("element", [this, i] { return std::string(steps[i]->element()); });
      steps[i].describe(g);
    };
    f.list(list);
  }
};

}  // namespace navvy::scene
