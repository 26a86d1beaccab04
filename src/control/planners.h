// SPDX-License-Identifier: Apache-2.0
// What an application hands to operators: makers of path planners and of job planners, and a reader
// of ordered programs.
#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "control/job_planner.h"
#include "control/path_planner.h"
#include "scene/ground.h"
#include "scene/program.h"

namespace navvy::control {

/// Function that reads the steps of a program for a machine on a ground. Its text contains the
/// elements that a scene file has inside <navvy:program>. It throws an InputError that names the
/// faults.
using ReadProgram = std::function<scene::Program(const std::string& steps, const scene::Machine&,
                                                 const scene::StartGround&)>;

/// Functions that make the planners of one machine. Empty functions mean that such planning is not
/// available. A maker of path planners converts to this type.
struct Planners {
  /// No planner is available.
  Planners() = default;
  /// Takes a maker of path planners, one of job planners, and a reader of programs.
  template <class Make,
            class = std::enable_if_t<std::is_constructible_v<MakePathPlanner, Make> &&
                                     !std::is_same_v<std::remove_cvref_t<Make>, Planners>>>
  Planners(Make&& make_paths, MakeJobPlanner make_jobs = {},  // NOLINT: implicit
           ReadProgram read = {})
      : paths(std::forward<Make>(make_paths)),
        jobs(std::move(make_jobs)),
        read_program(std::move(read)) {}

  /// Makes a path planner.
  MakePathPlanner paths;
  /// Makes a job planner.
  MakeJobPlanner jobs;
  /// Reads a program that is ordered during a run; empty: none can be ordered.
  ReadProgram read_program;
};

}  // namespace navvy::control
