// SPDX-License-Identifier: Apache-2.0
#include "record/path_file.h"

#include <cmath>
#include <cstdio>
#include <sstream>

#include "core/error.h"
#include "core/file.h"

namespace navvy::record {
namespace {

// Distance between places of the table [m].
constexpr double kStep = 0.1;

}  // namespace

std::string path_header() { return "machine,step,plan,time_s,s_m,x_m,y_m,yaw_rad,sense"; }

std::string path_rows(const std::string& machine, const std::vector<control::PlannedPath>& paths) {
  std::string out;
  for (const control::PlannedPath& each : paths) {
    // Paths that were planned ahead come first, so those of one step need not be adjacent.
    int plan = 1;
    for (const control::PlannedPath& before : paths) {
      if (&before == &each) break;
      plan += before.step == each.step ? 1 : 0;
    }
    const double length = each.path.length();
    const int places = static_cast<int>(std::ceil(length / kStep));
    for (int i = 0; i <= places; ++i) {
      const double s = i < places ? i * kStep : length;
      const control::PlanePose at = each.path.at(s);
      double sense = 1;
      for (const control::PathLeg& leg : each.path.legs())
        if (s >= leg.begin) sense = leg.sense;
      char text[160];
      std::snprintf(text, sizeof text, ",%lld,%d,%.6g,%.4f,%.4f,%.4f,%.5f,%g\n",
                    static_cast<long long>(each.step), plan, each.time, s, at.p.x(), at.p.y(),
                    at.yaw, sense);
      out += machine + text;
    }
  }
  return out;
}

// The table is one of our own, so that a row of another form means a wrong or damaged file.
std::vector<map::MapLine> read_paths(const std::string& file) {
  const std::vector<char> bytes = read_file(file);
  std::istringstream rows(std::string(bytes.begin(), bytes.end()));
  std::vector<map::MapLine> out;
  std::string row, whose;
  int line = 0;
  while (std::getline(rows, row)) {
    const bool header = ++line == 1;
    if (header && row == path_header()) continue;
    // Names of machines have no comma.
    const std::size_t comma = row.find(',');
    long long step = 0;
    int plan = 0;
    double time = 0, s = 0, x = 0, y = 0;
    if (header || comma == std::string::npos ||
        std::sscanf(row.c_str() + comma, ",%lld,%d,%lf,%lf,%lf,%lf", &step, &plan, &time, &s, &x,
                    &y) != 6)
      throw InputError(Fault{Fault::Severity::kError, file, line, "paths", row.substr(0, 60),
                             "must be " + path_header(),
                             "give the folder of a run whose program has a go_to"});
    const std::string now =
        row.substr(0, comma) + "," + std::to_string(step) + "," + std::to_string(plan);
    if (out.empty() || now != whose) out.push_back({plan, {}});
    whose = now;
    out.back().places.emplace_back(x, y);
  }
  return out;
}

}  // namespace navvy::record
