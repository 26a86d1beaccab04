// SPDX-License-Identifier: Apache-2.0
// The part of summary.json that reports how each operator program ended.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "session/session.h"

namespace navvy::record {

/// Returns a JSON array with one entry per program, in the order of the machines. An entry holds
/// machine, state, reason, end time and position of the program's latest step, and a list of all
/// steps with their states and measurements. `status` is the status of the run (RunStatus::status).
/// If it is not "running", programs that have not ended are reported as interrupted, with the
/// reason.
nlohmann::json program_list(const session::Session& session, const std::string& status);

}  // namespace navvy::record
