// SPDX-License-Identifier: Apache-2.0
// The part of summary.json that reports how each program ended.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "session/session.h"

namespace navvy::record {

/// Returns an entry for each program, in the order of the machines: machine, step, state, reason,
/// time, place, and the same for each step with its measurements. `status` is that of the run:
/// programs that still ran when it was interrupted or failed are reported as interrupted.
nlohmann::json program_list(const session::Session& session, const std::string& status);

}  // namespace navvy::record
