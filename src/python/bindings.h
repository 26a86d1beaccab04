// SPDX-License-Identifier: Apache-2.0
// Parts of the extension module, one function per source file, and what they share.
#pragma once

#include <nanobind/nanobind.h>

#include "python/runner.h"

namespace navvy::python {

/// Translates Navvy's exceptions to those of navvy._errors.
void bind_errors();
/// Binds the class SceneData and the function load_scene.
void bind_scene(nanobind::module_& module);
/// Binds the classes Channel and Runner.
void bind_world(nanobind::module_& module);
/// Adds the arrays of a world to the class Runner: heights, layers, particles, sensors.
void bind_arrays(nanobind::module_& module, nanobind::class_<Runner>& type);

/// Passes the messages of the libraries to Python's logger "navvy". The caller holds Python's lock.
void log_messages();
/// Runs Python's handlers of signals; takes Python's lock meanwhile. @throws what a handler raises,
/// such as KeyboardInterrupt.
void poll_signals();

}  // namespace navvy::python
