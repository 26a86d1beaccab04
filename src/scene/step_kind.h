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

/// The element of a program step while it is being read. A step's `check` function uses it for
/// rules that ranges of single fields cannot express.
///
/// `machine` and `ground` are null if they could not be read; rules that need them are then
/// skipped.
class StepSource {
 public:
  StepSource(const Machine* on_machine, const StartGround* on_ground)
      : machine(on_machine), ground(on_ground) {}
  virtual ~StepSource() = default;

  /// Reads all fields of `step` from the element and reports invalid and unknown child elements.
  virtual void read(Step& step) const = 0;
  /// Returns true if the child element is present, even if its value is invalid.
  virtual bool has(const char* name) const = 0;
  /// Returns the text of a child element as written in the file; empty if the child is absent.
  virtual std::string written(const char* name) const = 0;
  /// Reports an error at the child element `name`, or at the step itself if `name` is empty or
  /// there is no such child. If several children have this name, `item` selects one of them,
  /// counted from 0.
  virtual void error(const char* name, const std::string& value, const std::string& rule,
                     const std::string& remedy = "", int item = 0) const = 0;

  /// Reports an error with the text `rule` at the step unless `fulfilled` is true. Does nothing for
  /// a machine that could not be read completely.
  void require(bool fulfilled, const char* rule) const;
  /// Reports an error at the child element `name` unless the position `place` (in W [m]) is on the
  /// site.
  void on_site(const char* name, const Vec2& place) const;

  const Machine* machine;
  const StartGround* ground;
};

/// One type of program step, for the table of all types that the loader receives.
struct StepKind {
  /// Name of the step's element in scene files; unique in the table.
  std::string element;
  /// One sentence for the reference of scene elements.
  std::string text;
  std::function<ProgramStep(const StepSource&)> read;
  /// Visits the fields of a step with default values.
  std::function<void(Fields&)> describe;
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
