// SPDX-License-Identifier: Apache-2.0
// How program steps are read: a table of kinds that the caller of the loader brings along.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scene/field_source.h"
#include "scene/ground.h"
#include "scene/machine.h"
#include "scene/program.h"

namespace navvy::scene {

/// What a step's reader sees: its element, and the machine and the site that the step is for. These
/// two are null where they could not be read; checks that need them are left out then.
struct StepSource {
  FieldSource& fields;
  const Machine* machine = nullptr;
  const StartGround* ground = nullptr;

  /// Reports `rule` at the step when its machine does not fulfil it. A machine without links is
  /// faulty itself and has been reported.
  void require(bool fulfilled, const char* rule) const;
  /// Reports the child `name` when the place it holds [m] in W lies beyond the site.
  void on_site(const char* name, const Vec2& place) const;
};

/// One row of the table: the element's name and what reads it.
struct StepKind {
  std::string element;  ///< unlike any other row's
  std::function<ProgramStep(const StepSource&)> read;
};
using StepKinds = std::vector<StepKind>;

/// A step with the values that its reader took, so that two programs can be compared
/// (scene/parameters.h).
ProgramStep read_noting(const StepSource& source,
                        const std::function<ProgramStep(const StepSource&)>& read);

/// The row of a description T, which has `T::kElement` and `static T T::read(const StepSource&)`.
template <class T>
StepKind step_kind() {
  return {T::kElement, [](const StepSource& source) {
            return read_noting(source,
                               [](const StepSource& noted) { return ProgramStep(T::read(noted)); });
          }};
}

}  // namespace navvy::scene
