// SPDX-License-Identifier: Apache-2.0
// `navvy lab iso6015` and `navvy lab iso10567`: ratings of machines, which need neither soil nor a
// device.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/rating_output.h"
#include "cli/validators.h"
#include "core/error.h"
#include "core/file.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"
#include "vehicle/rating/lift_capacity.h"
#include "vehicle/rating/tool_force.h"

namespace navvy::cli {
namespace {

/// Options as parsed.
struct RatingOptions {
  std::vector<std::string> machines;
  std::vector<double> reaches, heights, headings = {0, 90};
  std::string csv, json;
  bool curve = false, with_bucket = false;
};

/// Returns the machines to rate: those that were named, or all shipped ones with a bucket. A
/// shipped machine without tool forces is left out with a line that gives the reason; one that was
/// named is an error.
std::vector<scene::Machine> machines_of(const RatingOptions& options) {
  std::vector<scene::Machine> out;
  for (const std::string& name : options.machines) {
    out.push_back(scene_io::load_machine(scene_io::find_machine(name, "machine")));
    if (const auto fault = vehicle::tool_force_fault(out.back())) throw InputError(*fault);
  }
  if (!options.machines.empty()) return out;
  for (const auto& [name, file] : scene_io::shipped_machines()) {
    scene::Machine machine = scene_io::load_machine(file);
    if (machine.buckets.empty()) continue;
    if (const auto fault = vehicle::tool_force_fault(machine)) {
      std::printf("%s is left out: %s needs %s\n", name.c_str(), fault->element.c_str(),
                  fault->rule.c_str());
      continue;
    }
    out.push_back(std::move(machine));
  }
  return out;
}

void write_files(const RatingOptions& options, const std::string& csv, const nlohmann::json& all) {
  if (!options.csv.empty()) write_file_atomically(options.csv, csv);
  if (!options.json.empty()) write_file_atomically(options.json, all.dump(1) + "\n");
}

/// Rates the tool forces of all machines.
int rate_tool_forces(const RatingOptions& options) {
  for (const std::string& file : {options.csv, options.json})
    if (!file.empty()) require_writable(file);
  std::vector<ToolForceRow> rows;
  for (const scene::Machine& machine : machines_of(options))
    for (const auto kind : {vehicle::ToolForceKind::kBreakout, vehicle::ToolForceKind::kTearOut})
      rows.push_back({machine.name, vehicle::rate_tool_force(machine, kind)});
  print_tool_forces(rows, options.curve);
  write_files(options, tool_force_csv(rows), tool_force_json(rows));
  return kOk;
}

/// Returns a heading [deg] within (-180, 180].
double wrapped(double heading) {
  const double out = std::remainder(heading, 360.0);
  return out == -180 ? 180 : out + 0.0;  // no negative zero
}

/// Returns multiples of 1.5 m within a range, the usual grid of lift charts.
std::vector<double> usual(double low, double high) {
  constexpr double kStep = 1.5;
  std::vector<double> out;
  for (double value = std::ceil(low / kStep) * kStep; value <= high; value += kStep)
    out.push_back(value);
  return out;
}

/// Rates the lift capacity of all machines.
int rate_lift_capacity(const RatingOptions& options) {
  for (const std::string& file : {options.csv, options.json})
    if (!file.empty()) require_writable(file);
  std::vector<LiftTable> tables;
  for (const scene::Machine& machine : machines_of(options)) {
    vehicle::LiftChart chart(machine, options.with_bucket);
    LiftTable table;
    table.machine = machine.name;
    table.with_bucket = options.with_bucket;
    for (const double heading : options.headings)
      table.headings.push_back(radians(wrapped(heading)));
    const auto [low, high] = chart.heights();
    table.heights = options.heights.empty() ? usual(low, high) : options.heights;
    // As in published charts, the highest first.
    std::sort(table.heights.rbegin(), table.heights.rend());
    double most = 0;
    for (const double height : table.heights)
      most = std::max(most, chart.max_reach(height).value_or(0));
    table.reaches = options.reaches.empty() ? usual(1.5, most) : options.reaches;
    fill(table, chart);
    tables.push_back(std::move(table));
  }
  print_lift_tables(tables);
  write_files(options, lift_csv(tables), lift_json(tables));
  return kOk;
}

void add_common(CLI::App& command, const std::shared_ptr<RatingOptions>& options) {
  command.add_option("machines", options->machines,
                     "shipped machines by name, or SDF files;\n"
                     "without any: all shipped machines with a bucket");
  command.add_option("--csv", options->csv, "write all results to this CSV file, in SI units");
  command.add_option("--json", options->json, "write all results to this JSON file, in SI units");
}

void add_tool_forces(CLI::App& lab, Action& action) {
  auto options = std::make_shared<RatingOptions>();
  CLI::App* command = lab.add_subcommand(
      "iso6015", "breakout and tear-out force of machines, with the limiting cause");
  add_common(*command, options);
  command->add_flag("--curve", options->curve,
                    "also print the forces over the range of the working joint");
  command->footer(
      "\nThe force at the middle of the bucket's cutting edge (tip_m), along its circle: about "
      "the bucket's pivot\n"
      "while the bucket cylinder works (breakout), about the stick's while the stick cylinder "
      "works (tear-out,\n"
      "with the bucket where its breakout force is largest). ISO 6015 takes the edge and not the "
      "tips of teeth:\n"
      "those ahead of it (length_m) are left out; those of the shipped buckets end at the edge.\n"
      "\nFor each force three positions of the arm, among all:\n"
      "  rated     the largest hydraulic force: the first circuit at its relief pressure, the "
      "working one or one\n"
      "            that must hold; weights and friction of the arm are excluded\n"
      "  alone     the largest force of the working circuit alone, as if the others held any load\n"
      "  standing  the largest force of the machine without an anchor\n"
      "Columns: working, the force of the working circuit alone; hydraulic, with the circuit "
      "that limits it; tips\n"
      "and slips, the forces at which the machine does; standing, the least of these, and its "
      "cause.\n"
      "\nThe ground is level and firm, with the friction of the tyres or tracks; brakes are on, "
      "the oscillating axle\n"
      "is locked, tyres are rigid.\n"
      "\nBoth forces of all shipped machines:\n"
      "  navvy lab iso6015\n"
      "\nA machine of your own, with the curve over the bucket's and the stick's range:\n"
      "  navvy lab iso6015 mine.sdf --curve --csv forces.csv");
  command->callback(
      [options, &action] { action = [options] { return rate_tool_forces(*options); }; });
}

void add_lift_capacity(CLI::App& lab, Action& action) {
  auto options = std::make_shared<RatingOptions>();
  CLI::App* command =
      lab.add_subcommand("iso10567", "lift capacity of machines over reach, height and swing");
  add_common(*command, options);
  const auto list = [&](const char* name, std::vector<double>& values, const char* help) {
    return command->add_option(name, values, help)->delimiter(',')->allow_extra_args(false);
  };
  list("--reach", options->reaches, "distances of the load from the swing axis [m]")
      ->check(above_zero);
  list("--height", options->heights, "heights of the load above the ground [m]")
      ->check(within(-100, 100));
  list("--swing-deg", options->headings,
       "directions of the arm from the front, to the left [deg], as of -180 to 180")
      ->check(within(-360, 360))
      ->default_str("0,90");
  command->add_flag("--bucket", options->with_bucket,
                    "with the bucket curled in, whose weight reduces the load");
  command->footer(
      "\nThe load hangs on the bucket's pivot. Its rated lift capacity is the smaller one of 87 "
      "% of the\n"
      "hydraulic lift capacity (marked *) and 75 % of the tipping load. The hydraulic lift "
      "capacity is the load\n"
      "at which the first circuit, of boom or stick, reaches its relief pressure while it "
      "holds load and arm.\n"
      "The tipping load moves the centre of mass onto an edge of the support polygon: a line "
      "between wheels or\n"
      "tracks. Lift charts are published without the bucket, as here without --bucket; a "
      "tool's weight is then\n"
      "part of the load. The last column is the largest reach at the height.\n"
      "\nThe ground is level and firm, tyres are rigid, the oscillating axle is locked.\n"
      "\nThe chart over the front and the side:\n"
      "  navvy lab iso10567 ew180\n"
      "\nAt one place, all round:\n"
      "  navvy lab iso10567 ew180 --reach 6 --height 1.5 --swing-deg 0,30,60,90,120,150,180 "
      "--csv lift.csv");
  command->callback(
      [options, &action] { action = [options] { return rate_lift_capacity(*options); }; });
}

}  // namespace

void add_ratings(CLI::App& lab, Action& action) {
  add_tool_forces(lab, action);
  add_lift_capacity(lab, action);
}

}  // namespace navvy::cli
