// SPDX-License-Identifier: Apache-2.0
// Kinds of program steps: a table that the caller of the loader provides.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/fields.h"
#include "scene/ground.h"
#include "scene/machine.h"
#include "scene/program.h"

namespace navvy::scene {

/// The element of a step while it is read, for rules beyond its fields. `machine` and `ground` are
/// null if they could not be read; rules that need them are skipped then.
class StepSource {
 public:
  StepSource(const Machine* on_machine, const StartGround* on_ground)
      : machine(on_machine), ground(on_ground) {}
  virtual ~StepSource() = default;

  /// Reads the fields of the step, and reports every faulty or unknown element.
  virtual void read(Step& step) const = 0;
  /// Returns true if the child element is present, valid or not.
  virtual bool has(const char* name) const = 0;
  /// Returns the text of a child element as the file has it; empty if it is absent.
  virtual std::string written(const char* name) const = 0;
  /// Reports an error at the child `name`; at the step if that is "" or absent. `item` counts
  /// children of one name from 0.
  virtual void error(const char* name, const std::string& value, const std::string& rule,
                     const std::string& remedy = "", int item = 0) const = 0;

  /// Reports `rule` at the step if its machine does not fulfil it. A machine without links has
  /// faults of its own, which have been reported.
  void require(bool fulfilled, const char* rule) const;
  /// Reports the child `name` if its place [m] in W is beyond the site.
  void on_site(const char* name, const Vec2& place) const;

  const Machine* machine;
  const StartGround* ground;
};

/// One row of the table.
struct StepKind {
  std::string element;  ///< unique name
  std::string text;     ///< one sentence for the reference
  std::function<ProgramStep(const StepSource&)> read;
  std::function<void(Fields&)> describe;  ///< visits the fields with their default values
};
using StepKinds = std::vector<StepKind>;

/// Returns the row of a step T, which has `T::kElement`, `T::kText`, `describe` and
/// `void check(const StepSource&)`. `check` runs after the fields were read.
template <class T>
StepKind step_kind() {
  return {T::kElement, T::kText,
          [](const StepSource& source) {
            T step;
            source.read(step);
            step.check(source);
            return ProgramStep(std::move(step));
          },
          [](Fields& f) { T().describe(f); }};
}

}  // namespace navvy::scene
