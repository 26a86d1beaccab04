// SPDX-License-Identifier: Apache-2.0
// What an operator is told to do, step by step. What steps there are is known to `control`; a scene
// only keeps them.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace navvy::scene {

/// A step that goes on only when another machine's program has come so far.
struct Waiting {
  std::string machine;
  int steps = 0;  ///< of that machine's program, done; 0: all
};

/// One step of a program as the scene describes it: values only, they never change after reading.
class Step {
 public:
  virtual ~Step() = default;
  /// Name of its element in a scene file, e.g. "drive_to".
  virtual const char* element() const = 0;
  /// For what it waits, if it does; programs that wait for each other in a circle are refused.
  virtual std::optional<Waiting> waits_for() const { return std::nullopt; }
  /// The hitch of its machine that it opens, if it does.
  virtual std::optional<std::string> opens() const { return std::nullopt; }

 protected:
  Step() = default;
  Step(const Step&) = default;
  Step& operator=(const Step&) = default;
};

/// A step of any kind, as a value: cheap to copy, the description behind it is shared and never
/// changes.
class ProgramStep {
 public:
  /// Values by the names of their elements, defaults too, as text in SI units.
  using Values = std::map<std::string, std::string>;

  template <class T, class = std::enable_if_t<std::is_base_of_v<Step, T>>>
  ProgramStep(T step)
      : step_(std::make_shared<const T>(std::move(step))) {}  // NOLINT: a step of a kind is a step

  const Step& operator*() const { return *step_; }
  const Step* operator->() const { return step_.get(); }
  /// Empty for a step that no file described.
  const Values& values() const {
    static const Values kNothing;
    return values_ ? *values_ : kNothing;
  }
  void set_values(Values values) { values_ = std::make_shared<const Values>(std::move(values)); }
  /// The description if it is of kind T, else null; to change it, assign a changed copy.
  template <class T>
  const T* as() const {
    return dynamic_cast<const T*>(step_.get());
  }

 private:
  std::shared_ptr<const Step> step_;
  std::shared_ptr<const Values> values_;
};

/// Steps of one machine, done one after the other.
struct Program {
  std::vector<ProgramStep> steps;
  std::vector<int> lines;  ///< line in the scene file of each step, for messages; may be empty
};

}  // namespace navvy::scene
