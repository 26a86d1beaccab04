// SPDX-License-Identifier: Apache-2.0
// Checks of options before the first step.
#pragma once

#include <string>

#include "run/simulation_options.h"
#include "session/session.h"

namespace navvy::run {

/// Returns "12.5" with at most six digits, for messages.
std::string short_text(double value);

/// Refuses a snapshot to save that would replace a file of another kind, or one that the run itself
/// writes. @throws InputError.
void check_snapshot(const std::string& path, const std::string& folder);
/// Refuses a snapshot to resume that cannot be read; an empty path is none. Cheap enough to ask
/// before the scene is loaded. @throws InputError.
void check_resume(const std::string& path);
/// Refuses a snapshot time that the run does not reach, and a resumed state with nothing left to
/// run. @throws InputError.
void check_times(const SimulationOptions& options, const session::Session& session);

}  // namespace navvy::run
