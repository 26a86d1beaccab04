// SPDX-License-Identifier: Apache-2.0
// `navvy lab iso11152`: energy of the same motion with and without soil.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/progress_line.h"
#include "cli/scene_options.h"
#include "core/file.h"
#include "core/printable.h"
#include "device/device.h"
#include "run/motion_energy.h"

namespace navvy::cli {
namespace {

/// Options as parsed.
struct EnergyOptions {
  SceneOptions scene;
  std::string machine, csv, json;
  bool quiet = false;
};

/// One line of the table: an energy with and without soil [J].
struct Row {
  std::string name;
  double with_soil = 0, without_soil = 0;
};

/// Returns the energies of the whole machine.
std::vector<Row> totals_of(const run::EnergyComparison& result) {
  return {{"work", result.with_soil.work, result.without_soil.work},
          {"pump", result.with_soil.pump, result.without_soil.pump}};
}

/// Returns the totals, then the work of each joint.
std::vector<Row> rows_of(const run::EnergyComparison& result) {
  std::vector<Row> out = totals_of(result);
  for (const run::JointWork& one : result.joints)
    out.push_back({one.joint, one.with_soil, one.without_soil});
  return out;
}

/// Returns an energy per mass that was moved [kJ/t] as text; "-" where nothing was moved.
std::string per_tonne(double joule, double moved) {
  if (!(moved > 0)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", joule / moved);  // J/kg = kJ/t
  return text;
}

void print(const run::EnergyComparison& result) {
  std::printf("%s: %.3f t dug in %d cycle%s, %.1f s\n", result.machine.c_str(), result.moved / 1000,
              result.cycles, result.cycles == 1 ? "" : "s", result.duration);
  std::printf("%-22s %14s %14s %14s %14s %14s\n", "energy", "with soil", "without soil",
              "difference", "with soil", "difference");
  std::printf("%-22s %14s %14s %14s %14s %14s\n", "", "[kJ]", "[kJ]", "[kJ]", "[kJ/t]", "[kJ/t]");
  for (const Row& row : rows_of(result))
    std::printf("%-22s %14.1f %14.1f %14.1f %14s %14s\n", row.name.c_str(), row.with_soil / 1000,
                row.without_soil / 1000, (row.with_soil - row.without_soil) / 1000,
                per_tonne(row.with_soil, result.moved).c_str(),
                per_tonne(row.with_soil - row.without_soil, result.moved).c_str());
  std::printf("paths of the bucket's edge differ by %.3f m (rms), %.3f m at most\n",
              result.path_rms, result.path_largest);
  if (result.end.reason == run::EndReason::kForbidden)
    std::printf("failed: %s\n", printable(result.end.cause).c_str());
  for (const std::string& program : result.unfinished)
    std::printf("incomplete: %s\n", printable(program).c_str());
}

/// Returns the exit status for the ending of the motion, as `navvy run` does: a duration on the
/// command line asks for no more than that.
int status_of(const EnergyOptions& options, const run::RunEnd& end) {
  if (end.reason == run::EndReason::kForbidden) return kForbidden;
  const bool asked = end.reason == run::EndReason::kOutOfTime && options.scene.duration > 0;
  return end.reason == run::EndReason::kComplete || asked ? kOk : kIncomplete;
}

std::string csv_of(const run::EnergyComparison& result) {
  std::string out = "energy,with_soil_j,without_soil_j,moved_kg\n";
  for (const Row& row : rows_of(result)) {
    char text[128];
    std::snprintf(text, sizeof text, ",%.6g,%.6g,%.6g\n", row.with_soil, row.without_soil,
                  result.moved);
    out += row.name + text;
  }
  return out;
}

nlohmann::json json_of(const EnergyOptions& options, const std::string& device,
                       const run::EnergyComparison& result) {
  nlohmann::json out = {{"rig", "iso11152"},
                        {"version", NAVVY_VERSION},
                        {"device", device},
                        {"scene", options.scene.file},
                        {"end", run::name_of(result.end.reason)},
                        {"unfinished", result.unfinished},
                        {"machine", result.machine},
                        {"duration_s", result.duration},
                        {"cycles", result.cycles},
                        {"moved_kg", result.moved},
                        {"path_rms_m", result.path_rms},
                        {"path_largest_m", result.path_largest}};
  if (!result.end.cause.empty()) out["forbidden_event"] = result.end.cause;
  const auto energy = [](double with_soil, double without_soil) {
    return nlohmann::json{{"with_soil_j", with_soil}, {"without_soil_j", without_soil}};
  };
  for (const Row& row : totals_of(result))
    out["energy"][row.name] = energy(row.with_soil, row.without_soil);
  // Of their own: a joint may be called like one of the totals.
  out["joints"] = nlohmann::json::object();
  for (const run::JointWork& one : result.joints)
    out["joints"][one.joint] = energy(one.with_soil, one.without_soil);
  return out;
}

int compare(const EnergyOptions& options) {
  // The runs may take minutes, so the files are checked first.
  for (const std::string& file : {options.csv, options.json})
    if (!file.empty()) require_writable(file);
  const scene::Scene scene = options.scene.load();
  device::Device device(options.scene.device);
  const run::EnergyComparison result =
      run::compare_motion_energy(scene, options.machine, device, progress_line(options.quiet));
  print(result);
  if (!options.csv.empty()) write_file_atomically(options.csv, csv_of(result));
  if (!options.json.empty())
    write_file_atomically(options.json,
                          json_of(options, device.info().text(), result).dump(1) + "\n");
  return status_of(options, result.end);
}

}  // namespace

void add_motion_energy(CLI::App& lab, Action& action) {
  auto options = std::make_shared<EnergyOptions>();
  CLI::App* command = lab.add_subcommand(
      "iso11152", "energy of the same motion with and without soil, per tonne moved");
  options->scene.add_to(*command);
  command->add_option("--machine", options->machine,
                      "machine of the scene; needed where several have a bucket");
  command->add_option("--csv", options->csv, "write the energies to this CSV file, in SI units");
  command->add_option("--json", options->json, "write the result to this JSON file, in SI units");
  command->add_flag("--quiet", options->quiet, "no progress line");
  command->footer(
      "\nThe scene runs twice: as it is, then without programs and without tools that touch "
      "soil, each joint\n"
      "commanded to the position and speed that it had. ISO 11152 measures energy with soil "
      "and in motions\n"
      "without; the difference is what the soil takes.\n"
      "\nwork: effort times speed of all joints and the drive. pump: flow times pressure. Then "
      "the joints of the\n"
      "arm. A load that drives its actuator returns nothing. Per tonne: over the mass that was "
      "dug on the whole\n"
      "site (earthwork of summary.json), so that no second machine may have a tool and a "
      "program. The motions\n"
      "are the same as far as the last line of the table says.\n"
      "\nPrograms that did not reach their end and forbidden events are printed; the exit status "
      "is then 6 or 8,\n"
      "as that of navvy run. A program that --duration cuts off is no failure.\n"
      "\nOne trench, about two minutes:\n"
      "  navvy lab iso11152 trench\n"
      "\nIts first scoops in stiff clay:\n"
      "  navvy lab iso11152 trench --set soil.ref=clay_stiff --duration 30");
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace navvy::cli
