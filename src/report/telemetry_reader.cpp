// SPDX-License-Identifier: Apache-2.0
#include "report/telemetry_reader.h"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "report/packing.h"

namespace navvy::report {
namespace {

using nlohmann::json;

constexpr std::string_view kPhase = "/phase";

std::vector<std::string> split(const std::string& row) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (std::size_t end = row.find(','); end != std::string::npos; end = row.find(',', begin)) {
    out.push_back(row.substr(begin, end - begin));
    begin = end + 1;
  }
  out.push_back(row.substr(begin));
  return out;
}

/// Reads the next row; false at the end, and for a row without its end, which a kill leaves.
bool next_row(std::ifstream& in, std::string& row) { return std::getline(in, row) && !in.eof(); }

/// The phases of one machine, as spans of time.
struct Spans {
  std::string machine;
  std::size_t column = 0;
  json list = json::array();

  void add(const std::string& phase, double time) {
    if (!list.empty()) list.back()["end_s"] = time;
    if (list.empty() || list.back()["name"] != phase)
      list.push_back({{"name", phase}, {"start_s", time}, {"end_s", time}});
  }
};

}  // namespace

std::size_t count_rows(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string row;
  if (!next_row(in, row)) return 0;
  std::size_t out = 0;
  while (next_row(in, row)) ++out;
  return out;
}

void read_telemetry(const std::string& file, std::size_t every, json& run) {
  run["telemetry"] = nullptr;
  run["phases"] = json::array();
  std::ifstream in(file, std::ios::binary);
  std::string row;
  if (!next_row(in, row)) return;
  const std::vector<std::string> header = split(row);
  json names = json::array(), units = json::array();
  std::vector<Spans> phases;
  std::size_t numbers = 0;  // columns before the phases
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string& title = header[i];
    if (title.ends_with(kPhase)) {
      phases.push_back({title.substr(0, title.size() - kPhase.size()), i, json::array()});
      continue;
    }
    // "name [unit]"
    const std::size_t bracket = title.rfind(" [");
    const bool has_unit = bracket != std::string::npos && title.ends_with(']');
    names.push_back(has_unit ? title.substr(0, bracket) : title);
    units.push_back(has_unit ? title.substr(bracket + 2, title.size() - bracket - 3) : "");
    ++numbers;
  }
  std::vector<float> values;
  std::size_t rows = 0, kept = 0;
  while (next_row(in, row)) {
    const std::vector<std::string> cells = split(row);
    if (cells.size() != header.size()) continue;
    const double time = std::strtod(cells[0].c_str(), nullptr);
    for (Spans& one : phases) one.add(cells[one.column], time);
    if (rows++ % every != 0) continue;
    ++kept;
    for (std::size_t i = 0; i < numbers; ++i)
      values.push_back(std::strtof(cells[i].c_str(), nullptr));
  }
  for (Spans& one : phases)
    run["phases"].push_back({{"machine", one.machine}, {"spans", std::move(one.list)}});
  if (kept > 0)
    run["telemetry"] = {
        {"names", names}, {"units", units}, {"rows", kept}, {"values", packed(values)}};
}

}  // namespace navvy::report
