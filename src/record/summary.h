// SPDX-License-Identifier: Apache-2.0
// summary.json: what a run came to. Its keys are an interface, documented in scenarios/README.md.
#pragma once

#include <string>
#include <vector>

#include "session/session.h"

namespace navvy::record {

inline constexpr int kSummarySchemaVersion = 1;

/// How the run stands: "running", "finished" (every program is done), "incomplete" (it ended, and a program did not),
/// "interrupted" or "failed".
struct RunStatus {
  std::string status = "running";
  std::string message;     ///< cause of a failure
  double start_time = 0;   ///< simulated time at which the run began: not 0 when it was resumed [s]
  double wall_time = 0;    ///< [s], without rendering
  double render_time = 0;  ///< [s]
  double record_time = 0;  ///< [s]
  int frames = 0;
};

/// The file's text: JSON, keys sorted, SI units in the names.
/// The hash costs a pass over the whole state; without it `state_hash` is null.
std::string summary_json(const session::Session& session, const RunStatus& status, bool with_hash = true);

/// Mass of one soil that left columns and that came to others [kg].
struct SoilMoved {
  double dug = 0, spoil = 0;
};

/// Earth moved by digging and dumping, wheel ruts apart: columns whose mass changed.
struct Earthwork {
  double bank_volume = 0;        ///< mass taken out of columns / bank density [m3]
  double loose_volume = 0;       ///< rise of the columns that gained mass [m3]
  std::vector<SoilMoved> soils;  ///< as the scene lists them
};
/// Soil that is awake over the column it came from does not count as dug.
Earthwork measure_earthwork(const sim::World& world);

}  // namespace navvy::record
