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

/// Condition of a step that waits for another machine's program.
struct Waiting {
  std::string machine;
  int steps = 0;  ///< completed steps of that machine's program; 0: all
};

/// One step of a program as the scene describes it. Its values do not change after reading.
class Step {
 public:
  virtual ~Step() = default;
  /// Returns the name of the step's element in a scene file, e.g. "drive_to".
  virtual const char* element() const = 0;
  /// Lists the fields of the step.
  virtual void describe(Fields& f) = 0;
  /// Returns the condition that the step waits for. Circles of waiting programs are refused.
  virtual std::optional<Waiting> waits_for() const { return std::nullopt; }
  /// Returns the hitch of its machine that the step opens.
  virtual std::optional<std::string> opens() const { return std::nullopt; }

 protected:
  Step() = default;
  Step(const Step&) = default;
  Step& operator=(const Step&) = default;
};

/// A step of any kind, as a value. Copies share the description.
class ProgramStep {
 public:
  template <class T, class = std::enable_if_t<std::is_base_of_v<Step, T>>>
  ProgramStep(T step) : step_(std::make_shared<T>(std::move(step))) {}  // NOLINT: implicit

  const Step& operator*() const { return *step_; }
  const Step* operator->() const { return step_.get(); }
  /// Visits the fields; the visitor must not write.
  void describe(Fields& f) const { step_->describe(f); }
  /// Returns the description if it is of kind T, else null.
  template <class T>
  const T* as() const {
    return dynamic_cast<const T*>(step_.get());
  }

 private:
  std::shared_ptr<Step> step_;
};

/// Steps of one machine, in order.
struct Program {
  std::vector<ProgramStep> steps;
  std::vector<int> lines;  ///< line in the scene file of each step, for messages; may be empty

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
