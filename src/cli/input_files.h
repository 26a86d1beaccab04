// SPDX-License-Identifier: Apache-2.0
// Files that a command reads: the scene of a run's folder, and inputs that an output must not
// replace.
#pragma once

#include <string>
#include <vector>

namespace navvy::cli {

/// Returns the scene file in the folder of a run. `command` names the command and `asked` what the
/// user named, for the message.
/// @throws InputError if there is none.
std::string scene_in(const std::string& folder, const std::string& command,
                     const std::string& asked);
/// Refuses an output that would overwrite one of the files `reads`, whatever its name. `named` is
/// the output as the user gave it, `outputs` are the files that it stands for.
/// @throws InputError that names the input.
void require_apart(const std::string& named, const std::vector<std::string>& outputs,
                   const std::vector<std::string>& reads);

}  // namespace navvy::cli
