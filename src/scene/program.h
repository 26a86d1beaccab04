// SPDX-License-Identifier: Apache-2.0
// The program of a machine, step by step. `control` knows the kinds of steps.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/limits.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Condition for a program step that waits for another machine's program.
struct Waiting {
  std::string machine;
  /// Number of steps that the other machine must have completed; 0: all of its steps.
  int steps = 0;
};

/// Description of one program step, as a scene defines it. The values never change after reading.
class Step {
 public:
  virtual ~Step() = default;
  /// Returns the name of the step's element in a scene file, e.g. "drive_to".
  virtual const char* element() const = 0;
  /// Visits the fields of the step.
  virtual void describe(Fields& f) = 0;
  /// Returns the condition that the step waits for; empty if it does not wait. The loader refuses
  /// programs that wait for each other in a circle.
  virtual std::optional<Waiting> waits_for() const { return std::nullopt; }
  /// Returns the name of the hitch that the step opens; empty if it opens none.
  virtual std::optional<std::string> opens() const { return std::nullopt; }

 protected:
  Step() = default;
  Step(const Step&) = default;
  Step& operator=(const Step&) = default;
};

/// A program step of any type, with value semantics. Copies share one immutable Step.
class ProgramStep {
 public:
  template <class T, class = std::enable_if_t<std::is_base_of_v<Step, T>>>
  ProgramStep(T step) : step_(std::make_shared<T>(std::move(step))) {}  // NOLINT: implicit

  const Step& operator*() const { return *step_; }
  const Step* operator->() const { return step_.get(); }
  /// Visits the fields of the step. The visitor must not modify them.
  void describe(Fields& f) const { step_->describe(f); }
  /// Returns the description if it is of kind T, else null.
  template <class T>
  const T* as() const {
    return dynamic_cast<const T*>(step_.get());
  }

 private:
  std::shared_ptr<Step> step_;
};

/// Program of one machine: the steps in order of execution.
struct Program {
  std::vector<ProgramStep> steps;
  /// Line of each step in the scene file, for messages; may be empty.
  std::vector<int> lines;

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
