// SPDX-License-Identifier: Apache-2.0
// What an application hands to operators that plan: makers of path planners and of job planners.
#pragma once

#include <type_traits>
#include <utility>

#include "control/job_planner.h"
#include "control/path_planner.h"

namespace navvy::control {

/// Functions that make the planners of one machine. Empty functions mean that such planning is not
/// available. A maker of path planners converts to this type.
struct Planners {
  /// No planner is available.
  Planners() = default;
  /// Takes a maker of path planners and one of job planners.
  template <class Make,
            class = std::enable_if_t<std::is_constructible_v<MakePathPlanner, Make> &&
                                     !std::is_same_v<std::remove_cvref_t<Make>, Planners>>>
  Planners(Make&& make_paths, MakeJobPlanner make_jobs = {})  // NOLINT: implicit
      : paths(std::forward<Make>(make_paths)), jobs(std::move(make_jobs)) {}

  /// Makes a path planner.
  MakePathPlanner paths;
  /// Makes a job planner.
  MakeJobPlanner jobs;
};

}  // namespace navvy::control
