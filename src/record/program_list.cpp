// SPDX-License-Identifier: Apache-2.0
#include "record/program_list.h"

#include <nlohmann/json.hpp>

namespace navvy::record {
namespace {

using nlohmann::json;

/// Returns the entry of a step. Measurements are keys of their own, whose names end in their units.
json step_entry(const control::StepReport& report) {
  json out = {{"step", report.step},
              {"kind", report.element},
              {"state", control::name_of(report.state)},
              {"reason", report.reason},
              {"start_s", report.start},
              {"end_s", report.end},
              {"place_m", {report.place.x(), report.place.y(), report.place.z()}}};
  for (const control::Measurement& one : report.measurements) out[one.name] = one.value;
  return out;
}

/// Marks a step that still ran when the run ended as interrupted.
void end_with(json& entry, const std::string& status, bool taken) {
  if (entry["state"] != control::name_of(control::StepState::kRunning) || status == "running")
    return;
  entry["state"] = taken ? "inputs" : "interrupted";
  entry["reason"] = taken                     ? "inputs drive the machine"
                    : status == "failed"      ? "the run stopped itself"
                    : status == "interrupted" ? "the run was interrupted"
                                              : "the controller ended the run";
}

}  // namespace

json program_list(const session::Session& session, const std::string& status) {
  json out = json::array();
  for (const session::ProgramReport& report : session.programs()) {
    json steps = json::array();
    for (const control::StepReport& step : report.list) {
      steps.push_back(step_entry(step));
      end_with(steps.back(), status, report.taken);
    }
    const json& last = steps.back();
    json entry = {
        {"machine",
         session.world().description().machines[static_cast<std::size_t>(report.machine)].name},
        {"steps", report.steps},
        {"step", last["step"]},
        {"kind", last["kind"]},
        {"state", last["state"]},
        {"reason", last["reason"]},
        {"time_s", last["end_s"]},
        {"place_m", last["place_m"]}};
    if (report.orders > 0) entry["orders"] = report.orders;
    if (report.by_inputs()) entry["state"] = "inputs", entry["reason"] = "inputs drive the machine";
    entry["step_list"] = std::move(steps);
    out.push_back(std::move(entry));
  }
  return out;
}

}  // namespace navvy::record
