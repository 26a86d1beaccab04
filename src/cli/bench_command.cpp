// SPDX-License-Identifier: Apache-2.0
// `navvy bench`: measures the speed of the soil, a row per case and device.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "bench/cost_model.h"
#include "bench/native_rows.h"
#include "bench/soil_rows.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "core/file.h"
#include "device/device.h"
#include "scene_io/shipped.h"

namespace navvy::cli {
namespace {

/// Options as parsed.
struct BenchOptions {
  std::vector<std::string> devices;
  std::string only, soil, csv, json;
  bool columns = false;
  bool quick = false, list = false;
  bool native = false, model = false;
};

/// Returns the devices to measure: each given name, all devices for "all", the usual choice without
/// a name.
std::vector<std::string> chosen(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    if (name != "all") out.push_back(name);
    if (name == "all")
      for (const device::DeviceInfo& info : device::list_devices())
        out.push_back(std::to_string(info.index));
  }
  if (out.empty()) out.emplace_back();
  return out;
}

/// Prints the columns of a row that matter to people; files have all of them.
void print_row(const bench::Row& row) {
  const std::vector<std::string> c = bench::cells(row);
  std::printf("%-20s %9s %6s %11s %11s %11s %9s %9s %9s  %s\n", c[0].c_str(), c[3].c_str(),
              c[4].c_str(), c[5].c_str(), c[6].c_str(), c[8].c_str(), c[10].c_str(), c[12].c_str(),
              c[13].c_str(), c[14].c_str());
  std::fflush(stdout);
}

/// Prints the names of the columns that print_row fills.
void print_heads(const device::DeviceInfo& device) {
  std::printf("%s\n%-20s %9s %6s %11s %11s %11s %9s %9s %9s  %s\n", device.text().c_str(), "bench",
              "particles", "steps", "min ms", "median ms", "part-step/s", "of copy", "of FMA",
              "real time", "state hash");
}

/// Prints what a bucket in ground of other sizes would cost, scaled from the row of a dig.
void print_predictions(const bench::CostModel& cost, const bench::Row& dig, double few,
                       double shares[2]) {
  const double dt = dig.simulated / static_cast<double>(dig.steps);
  const double blocks = dig.active_blocks / static_cast<double>(dig.particles);
  std::printf("A bucket in the ground as in `%s`, time steps of %.2g ms:\n%12s %15s %12s %17s\n",
              dig.bench.c_str(), 1e3 * dt, "particles", "processor ms", "wall ms",
              "real-time factor");
  for (const double particles : {2e3, 5e3, 10e3, 20e3, 50e3, 100e3, 200e3, 500e3, 1e6}) {
    const double seconds = cost.step_seconds(blocks * particles, particles, dig.contact_nodes);
    const double wall = seconds * shares[particles < few ? 0 : 1];
    std::printf("%12.0f %15.2f %12.2f %17.2f\n", particles, 1e3 * seconds, 1e3 * wall, dt / wall);
  }
}

/// Fits a model of the cost of a step to the rows of one device and prints it with its errors.
void print_model(const device::Device& device, const std::vector<bench::Row>& rows) {
  const bench::CostModel cost = bench::fit_cost(rows);
  std::printf(
      "Processor time of a soil step, fitted to %zu rows: %.3g ms + %.3g us per active block\n"
      "  + %.3g ns per particle + %.3g ns per contact node; largest error of a row %.0f %%\n",
      rows.size(), 1e3 * cost.step, 1e6 * cost.block, 1e9 * cost.particle, 1e9 * cost.node,
      100 * cost.worst);
  std::printf("%-26s %9s %8s %8s %12s %9s %7s\n", "bench", "particles", "blocks", "nodes",
              "processor ms", "model ms", "error");
  for (const bench::Row& row : rows) {
    const double measured = bench::measured_step_seconds(row), model = cost.step_seconds(row);
    std::printf("%-26s %9llu %8.0f %8.0f %12.3f %9.3f %+6.0f%%\n", row.bench.c_str(),
                static_cast<unsigned long long>(row.particles), row.active_blocks,
                row.contact_nodes, 1e3 * measured, 1e3 * model, 100 * (model / measured - 1));
  }
  const double few = bench::caller_below(device);
  double shares[2] = {bench::wall_share(rows, 0, few), bench::wall_share(rows, few, 1e12)};
  std::printf(
      "Wall time / processor time: %.2f below %.0f particles (caller's thread), %.2f above\n",
      shares[0], few, shares[1]);
  const auto dig = std::find_if(rows.begin(), rows.end(), [](const bench::Row& row) {
    return row.bench.rfind("soil_dig:", 0) == 0;
  });
  if (dig != rows.end()) print_predictions(cost, *dig, few, shares);
}

/// Lists what could be measured.
int list_cases() {
  for (const bench::SoilCase& c : bench::soil_cases())
    std::printf("%-20s %s%s\n", c.name.c_str(), c.help.c_str(), c.quick ? " (quick)" : "");
  return kOk;
}

/// Writes the rows to the files that were asked for.
void write_rows(const BenchOptions& options, const std::vector<bench::Row>& rows) {
  std::string csv = bench::csv_header() + "\n";
  for (const bench::Row& row : rows) csv += bench::csv_line(row) + "\n";
  if (!options.csv.empty()) write_file_atomically(options.csv, csv);
  if (!options.json.empty()) write_file_atomically(options.json, bench::json(rows));
}

/// Measures every case on every chosen device.
int run_bench(const BenchOptions& options) {
  if (options.columns) {
    std::printf("%s\n", bench::csv_header().c_str());
    return kOk;
  }
  if (options.list) return list_cases();
  bench::SoilChoice choice{options.only, options.quick};
  if (!options.soil.empty()) choice.soil = scene_io::shipped_soil(options.soil, "--soil");
  // A sweep takes minutes, so the files are checked first.
  for (const std::string& path : {options.csv, options.json})
    if (!path.empty()) require_writable(path);
  std::vector<bench::Row> rows;
  for (const std::string& name : chosen(options.devices)) {
    device::Device device(name);
    print_heads(device.info());
    std::vector<bench::Row> own;
    const auto take = [&](const bench::Row& row) {
      rows.push_back(row);
      own.push_back(row);
      print_row(row);
      // Files are written after each row, so that an interrupted sweep keeps its results.
      write_rows(options, rows);
    };
    if (!options.native) {
      bench::run_soil_cases(device, choice, take);
      if (options.model) print_model(device, own);
      continue;
    }
    bench::run_native_cases(device, options.only, take);
    for (std::size_t i = 0; i + 1 < own.size(); i += 2) {
      const bench::NativeRatio ratio = bench::native_ratio(own[i], own[i + 1]);
      std::printf("%s: OpenCL steps / native loop %.2f, by processor time %.2f\n",
                  own[i].bench.c_str(), ratio.wall, ratio.processor);
    }
  }
  return kOk;
}

}  // namespace

void add_bench(CLI::App& app, Action& action) {
  auto options = std::make_shared<BenchOptions>();
  CLI::App* command = app.add_subcommand("bench", "measure the speed of the soil on this machine");
  command->add_option("only", options->only, "only cases whose name contains this word");
  command
      ->add_option("--device", options->devices,
                   "OpenCL device, as in `navvy run`; repeatable, or 'all'")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* soil =
      command->add_option("--soil", options->soil,
                          "a soil of terrain/soils by name (`navvy soils`) in place of dry sand");
  command->add_option("--csv", options->csv,
                      "write the rows to this file (compare two: bench/compare.py)");
  command->add_option("--json", options->json, "write the rows to this file");
  CLI::Option* quick = command->add_flag("--quick", options->quick, "only the short cases");
  CLI::Option* model = command->add_flag(
      "--model", options->model,
      "fit the cost of a step to the rows and print what other numbers of particles would cost");
  command
      ->add_flag("--native", options->native,
                 "measure a collapsing block beside a loop in C++ of the same method")
      ->excludes(soil, quick, model);
  command->add_flag("--list", options->list, "list the cases");
  command->add_flag("--columns", options->columns, "print the names of the columns of --csv");
  command->footer(
      "Examples:\n"
      "  navvy bench --quick                   a minute on two cores\n"
      "  navvy bench --model --soil loam       what a scene in loam will cost here\n"
      "  navvy bench soil_dig --csv dig.csv    digs only, rows to a file");
  command->callback([options, &action] { action = [options] { return run_bench(*options); }; });
}

}  // namespace navvy::cli
