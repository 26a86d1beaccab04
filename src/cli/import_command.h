// SPDX-License-Identifier: Apache-2.0
// `navvy import`: makes a machine of Navvy from one of another simulator.
#pragma once

#include "cli/commands.h"

namespace navvy::cli {

/// Adds `navvy import`, which writes a machine of SDF or URDF as one of our own.
void add_import(CLI::App& app, Action& action);

}  // namespace navvy::cli
