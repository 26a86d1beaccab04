// SPDX-License-Identifier: Apache-2.0
// The part of summary.json that tells how each program ended.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "session/session.h"

namespace navvy::record {

/// One entry a program, in the order of the machines: machine, step, state, reason, time, place,
/// and the same of each step with the figures of its account. `status` is the run's: in one that
/// was interrupted or failed, programs that still ran were, too.
nlohmann::json program_list(const session::Session& session, const std::string& status);

}  // namespace navvy::record
