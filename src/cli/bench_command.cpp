// SPDX-License-Identifier: Apache-2.0
// `navvy bench`: measures the speed of the soil, a row per case and device.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "bench/soil_rows.h"
#include "cli/commands.h"
#include "cli/exit_code.h"
#include "core/file.h"
#include "device/device.h"

namespace navvy::cli {
namespace {

/// Options as parsed.
struct BenchOptions {
  std::vector<std::string> devices;
  std::string only, csv, json;
  bool columns = false;
  bool quick = false, list = false;
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

/// Measures every case on every chosen device, or lists what could be measured.
int run_bench(const BenchOptions& options) {
  if (options.columns) {
    std::printf("%s\n", bench::csv_header().c_str());
    return kOk;
  }
  if (options.list) {
    for (const bench::SoilCase& c : bench::soil_cases())
      std::printf("%-20s %s%s\n", c.name.c_str(), c.help.c_str(), c.quick ? " (quick)" : "");
    return kOk;
  }
  // A sweep takes minutes, so the files are checked first.
  for (const std::string& path : {options.csv, options.json})
    if (!path.empty()) require_writable(path);
  std::vector<bench::Row> rows;
  for (const std::string& choice : chosen(options.devices)) {
    device::Device device(choice);
    std::printf("%s\n%-20s %9s %6s %11s %11s %11s %9s %9s %9s  %s\n", device.info().text().c_str(),
                "bench", "particles", "steps", "min ms", "median ms", "part-step/s", "of copy",
                "of FMA", "real time", "state hash");
    bench::run_soil_cases(device, options.only, options.quick, [&](const bench::Row& row) {
      rows.push_back(row);
      print_row(row);
      // Files are written after each row, so that an interrupted sweep keeps its results.
      std::string csv = bench::csv_header() + "\n";
      for (const bench::Row& r : rows) csv += bench::csv_line(r) + "\n";
      if (!options.csv.empty()) write_file_atomically(options.csv, csv);
      if (!options.json.empty()) write_file_atomically(options.json, bench::json(rows));
    });
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
  command->add_option("--csv", options->csv,
                      "write the rows to this file (compare two: bench/compare.py)");
  command->add_option("--json", options->json, "write the rows to this file");
  command->add_flag("--quick", options->quick, "only the short cases");
  command->add_flag("--list", options->list, "list the cases");
  command->add_flag("--columns", options->columns, "print the names of the columns of --csv");
  command->callback([options, &action] { action = [options] { return run_bench(*options); }; });
}

}  // namespace navvy::cli
