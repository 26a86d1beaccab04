// SPDX-License-Identifier: Apache-2.0
#include "session/reports.h"

#include <array>
#include <cstdio>

namespace navvy::session {

void Cycle::visit(Archive& a) {
  a("machine", machine);
  a("start", start);
  a("curl", curl);
  a("lift_out", lift_out);
  a("dump_start", dump_start);
  a("end", end);
  a("payload_lift_out", payload_lift_out);
  a("payload_dump", payload_dump);
  a("force_peak", force_peak);
  a("draft_peak", draft_peak);
  a("uplift_peak", uplift_peak);
  a.unhashed("follows from the states before; states of equal runs keep their hashes",
             [&] { a("place", place); });
}

void BedTip::visit(Archive& a) {
  a("machine", machine);
  a("start", start);
  a("end", end);
  a("payload_start", payload_start);
  a("payload_end", payload_end);
}

void ForceStatistics::visit(Archive& a) {
  a("peak", peak);
  a("draft_peak", draft_peak);
  a("sum", sum);
  a("steps", steps);
  a("rock_peak", rock_peak);
  a("residual_max", residual_max);
}

std::string report_line(const ProgramReport& report, const std::string& name,
                        const std::string& cut) {
  const control::StepReport& last = report.last();
  std::array<char, 96> where{};
  std::snprintf(where.data(), where.size(), " (%.2f s, at %.2f, %.2f m)", last.end, last.place.x(),
                last.place.y());
  // Only a step that was still running is cut; one that had ended keeps its own state.
  const bool is_cut = !cut.empty() && last.state == control::StepState::kRunning;
  const std::string state = report.by_inputs() ? "inputs"
                            : is_cut           ? "interrupted"
                                               : control::name_of(last.state);
  const std::string& reason = is_cut ? cut : last.reason;
  const std::string step =
      ", step " + std::to_string(last.step) + " of " + std::to_string(report.steps);
  // A machine that fell did so in no particular step.
  return "'" + name + "'" + (report.fell() ? "" : step) + " (" + last.element + "): " + state +
         (reason.empty() ? "" : ": " + reason) + where.data();
}

}  // namespace navvy::session
