// SPDX-License-Identifier: Apache-2.0
// Checks of simulation options before the first step.
#pragma once

#include <string>

#include "device/source.h"
#include "run/simulation_options.h"
#include "session/session.h"

namespace navvy::run {

/// Returns `value` as text with at most six significant digits, such as "12.5", for messages.
std::string short_text(double value);

/// Checks that a snapshot may be written to the file `path`; an empty path is accepted. `folder` is
/// the output folder of the run, or empty. @throws InputError if `path` is an existing file that is
/// not a snapshot, or a file that the run itself writes to `folder`.
void check_snapshot(const std::string& path, const std::string& folder);
/// Checks that the snapshot `path` can be read; an empty path is accepted. The check is fast, so it
/// can be made before the scene is loaded. @throws InputError.
void check_resume(const std::string& path);
/// Checks the times of snapshots. @throws InputError if SimulationOptions::snapshot_at is later
/// than the maximum duration of the run, or if a run is resumed from a snapshot at which the run is
/// already done.
void check_times(const SimulationOptions& options, const session::Session& session);

/// Returns the line of the log for kernels that are not the shipped ones; at least one has changed.
std::string changed_kernels_note(const device::KernelSources& kernels);

}  // namespace navvy::run
