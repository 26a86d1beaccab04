// SPDX-License-Identifier: Apache-2.0
// Types of program steps: a table that the caller of the loader provides.
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

/// The XML element of a step while it is being read, for rules that concern more than one field.
/// `machine` and `ground` are null if they could not be read; rules that need them are then
/// skipped.
class StepSource {
 public:
  /// Stores the machine that executes the step and the ground of the scene; either may be null.
  StepSource(const Machine* on_machine, const StartGround* on_ground)
      : machine(on_machine), ground(on_ground) {}
  virtual ~StepSource() = default;

  /// Reads the fields of the step, and reports every invalid or unknown child element.
  virtual void read(Step& step) const = 0;
  /// Returns true if the element has a child `name`, whether that is valid or not.
  virtual bool has(const char* name) const = 0;
  /// Returns the text of the child `name` as in the file; empty if there is none.
  virtual std::string written(const char* name) const = 0;
  /// Reports an error at the child `name`, or at the step itself if `name` is "" or there is no
  /// such child. `value` is the invalid text, `rule` what is allowed, and `remedy` how to correct
  /// it. `item` is the 0-based index among several children with this name.
  virtual void error(const char* name, const std::string& value, const std::string& rule,
                     const std::string& remedy = "", int item = 0) const = 0;

  /// Reports an error with the text `rule` at the step if `fulfilled` is false. It does nothing for
  /// a machine that is null or has no links, as the cause has been reported already.
  void require(bool fulfilled, const char* rule) const;
  /// Reports an error at the child `name` if the point `place` in W [m] lies outside the site. Does
  /// nothing without that child or if `ground` is null.
  void on_site(const char* name, const Vec2& place) const;

  const Machine* machine;     ///< machine that executes the step; null if it could not be read
  const StartGround* ground;  ///< ground of the scene; null if it could not be read
};

/// One type of step, a row of the table.
struct StepKind {
  std::string element;                                 ///< unique name of the step's element
  std::string text;                                    ///< one sentence for the reference page
  std::function<ProgramStep(const StepSource&)> read;  ///< reads and checks a step of this type
  std::function<void(Fields&)> describe;  ///< visits the fields of a step with default values
};
/// The table of all types of steps.
using StepKinds = std::vector<StepKind>;

/// Returns the table row for the step class T. T must have `T::kElement` (element name), `T::kText`
/// (sentence for the reference page), `describe`, and `void check(const StepSource&)`, which is
/// called after the fields have been read.
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
