// SPDX-License-Identifier: Apache-2.0
#include "cli/rating_output.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/math.h"

namespace navvy::cli {
namespace {

using vehicle::LiftCapacity;
using vehicle::RatedToolForce;

const char* word(vehicle::ToolForceKind kind) {
  return kind == vehicle::ToolForceKind::kBreakout ? "breakout" : "tear-out";
}

/// Returns a force [kN] with one decimal; "-" if it is infinite.
std::string kilonewtons(double force) {
  if (!std::isfinite(force)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", force / 1000);
  return text;
}

/// Returns a number for CSV, exact to six digits; empty if it is not finite.
std::string number(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// Returns a text as a field of a CSV table.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

/// Joins fields to a line.
std::string line(const std::vector<std::string>& fields) {
  std::string out;
  for (const std::string& one : fields) out += (out.empty() ? "" : ",") + one;
  return out + "\n";
}

/// JSON has no infinity.
nlohmann::json finite(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

void print_force(const std::string& machine, const char* kind, const char* position,
                 const RatedToolForce& f) {
  std::printf("%-14s %-9s %-9s %7s %9s %-16s %7s %7s %9s %-10s %5.0f %5.0f %6.0f %7.2f %7.2f\n",
              machine.c_str(), kind, position, kilonewtons(f.working).c_str(),
              kilonewtons(f.hydraulic).c_str(), f.circuit.c_str(), kilonewtons(f.tipping).c_str(),
              kilonewtons(f.slipping).c_str(), kilonewtons(f.standing()).c_str(),
              vehicle::name_of(f.limit()), degrees(f.boom), degrees(f.stick), degrees(f.bucket),
              f.reach, f.height);
}

nlohmann::json to_json(const RatedToolForce& f) {
  return {{"boom_deg", degrees(f.boom)},
          {"stick_deg", degrees(f.stick)},
          {"bucket_deg", degrees(f.bucket)},
          {"reach_m", f.reach},
          {"height_m", f.height},
          {"radius_m", f.radius},
          {"working_n", f.working},
          {"hydraulic_n", f.hydraulic},
          {"circuit", f.circuit},
          {"tipping_n", finite(f.tipping)},
          {"slipping_n", finite(f.slipping)},
          {"standing_n", f.standing()},
          {"limit", vehicle::name_of(f.limit())}};
}

std::string csv_line(const ToolForceRow& row, const char* position, const RatedToolForce& f) {
  return line({field(row.machine), word(row.rating.kind), position, number(degrees(f.boom)),
               number(degrees(f.stick)), number(degrees(f.bucket)), number(f.reach),
               number(f.height), number(f.radius), number(f.working), number(f.hydraulic),
               field(f.circuit), number(f.tipping), number(f.slipping), number(f.standing()),
               vehicle::name_of(f.limit())});
}

/// Returns "over the front", "over the left side", "over the right side", "over the rear", or the
/// angle.
std::string heading_text(double heading) {
  const double angle = std::round(degrees(heading) * 1e6) / 1e6;
  if (angle == 0) return "over the front";
  if (angle == 90) return "over the left side";
  if (angle == -90) return "over the right side";
  if (angle == 180 || angle == -180) return "over the rear";
  char text[48];
  std::snprintf(text, sizeof text, "%g deg from the front", angle);
  return text;
}

/// Returns the rated capacity in tonnes, marked if the hydraulics decide it.
std::string tonnes(const std::optional<LiftCapacity>& at) {
  if (!at) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f%s", at->rated() / 1000, at->is_hydraulic() ? "*" : " ");
  return text;
}

void print_lift_table(const LiftTable& table) {
  for (std::size_t h = 0; h < table.headings.size(); ++h) {
    std::printf("\n%s %s, %s: rated lift capacity [t]\n%-12s", table.machine.c_str(),
                heading_text(table.headings[h]).c_str(),
                table.with_bucket ? "with its bucket" : "without bucket", "height [m]");
    for (const double reach : table.reaches) std::printf(" %7.2f ", reach);
    std::printf("  largest reach [m]\n");
    bool any = false;
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      const LiftTable::Line& at = table.lines[i];
      for (const auto& one : at.at_reach[h]) any = any || one.has_value();
      any = any || at.at_most[h].has_value();
      std::printf("%-12.2f", table.heights[i]);
      for (const auto& one : at.at_reach[h]) std::printf(" %8s", tonnes(one).c_str());
      if (at.at_most[h])
        std::printf("  %8s at %.2f", tonnes(at.at_most[h]).c_str(), at.at_most[h]->reach);
      std::printf("\n");
    }
    if (!any) std::puts("the arm does not turn there, or reaches none of these places");
  }
}

/// Calls `each` for all capacities of a table; `most` is true at the largest reach.
template <typename Each>
void over(const LiftTable& table, const Each& each) {
  for (const LiftTable::Line& at : table.lines)
    for (std::size_t h = 0; h < table.headings.size(); ++h) {
      for (const auto& one : at.at_reach[h])
        if (one) each(*one, false);
      if (at.at_most[h]) each(*at.at_most[h], true);
    }
}

}  // namespace

void print_tool_forces(const std::vector<ToolForceRow>& rows, bool curve) {
  std::printf("%-14s %-9s %-9s %7s %9s %-16s %7s %7s %9s %-10s %5s %5s %6s %7s %7s\n", "machine",
              "force", "position", "working", "hydraulic", "circuit", "tips", "slips", "standing",
              "limit", "boom", "stick", "bucket", "reach", "height");
  std::printf("%-14s %-9s %-9s %7s %9s %-16s %7s %7s %9s %-10s %5s %5s %6s %7s %7s\n", "", "", "",
              "[kN]", "[kN]", "", "[kN]", "[kN]", "[kN]", "", "[deg]", "[deg]", "[deg]", "[m]",
              "[m]");
  for (const ToolForceRow& row : rows) {
    print_force(row.machine, word(row.rating.kind), "rated", row.rating.rated);
    print_force(row.machine, word(row.rating.kind), "alone", row.rating.alone);
    print_force(row.machine, word(row.rating.kind), "standing", row.rating.standing);
  }
  for (const ToolForceRow& row : rows)
    for (const RatedToolForce& f : row.rating.curve)
      if (curve) print_force(row.machine, word(row.rating.kind), "curve", f);
}

std::string tool_force_csv(const std::vector<ToolForceRow>& rows) {
  std::string out =
      "machine,force,position,boom_deg,stick_deg,bucket_deg,reach_m,height_m,radius_m,working_n,"
      "hydraulic_n,"
      "circuit,tipping_n,slipping_n,standing_n,limit\n";
  for (const ToolForceRow& row : rows) {
    out += csv_line(row, "rated", row.rating.rated);
    out += csv_line(row, "alone", row.rating.alone);
    out += csv_line(row, "standing", row.rating.standing);
    for (const RatedToolForce& f : row.rating.curve) out += csv_line(row, "curve", f);
  }
  return out;
}

nlohmann::json tool_force_json(const std::vector<ToolForceRow>& rows) {
  nlohmann::json out = {{"rig", "iso6015"}, {"version", NAVVY_VERSION}};
  out["forces"] = nlohmann::json::array();
  for (const ToolForceRow& row : rows) {
    nlohmann::json one = {{"machine", row.machine},
                          {"force", word(row.rating.kind)},
                          {"rated", to_json(row.rating.rated)},
                          {"alone", to_json(row.rating.alone)},
                          {"standing", to_json(row.rating.standing)}};
    one["curve"] = nlohmann::json::array();
    for (const RatedToolForce& f : row.rating.curve) one["curve"].push_back(to_json(f));
    out["forces"].push_back(std::move(one));
  }
  return out;
}

void fill(LiftTable& table, vehicle::LiftChart& chart) {
  for (const double height : table.heights) {
    LiftTable::Line at;
    const std::optional<double> most = chart.max_reach(height);
    for (const double heading : table.headings) {
      at.at_reach.emplace_back();
      for (const double reach : table.reaches)
        at.at_reach.back().push_back(chart.at(reach, height, heading));
      at.at_most.push_back(most ? chart.at(*most, height, heading) : std::nullopt);
    }
    table.lines.push_back(std::move(at));
  }
}

void print_lift_tables(const std::vector<LiftTable>& tables) {
  std::puts("* 87 % of the hydraulic lift capacity; otherwise 75 % of the tipping load");
  for (const LiftTable& table : tables) print_lift_table(table);
}

std::string lift_csv(const std::vector<LiftTable>& tables) {
  std::string out =
      "machine,bucket,swing_deg,height_m,reach_m,largest_reach,boom_deg,stick_deg,hydraulic_kg,"
      "circuit,tipping_kg,rated_kg,limit\n";
  for (const LiftTable& table : tables)
    over(table, [&](const LiftCapacity& at, bool most) {
      out += line({field(table.machine), table.with_bucket ? "yes" : "no",
                   number(degrees(at.heading)), number(at.height), number(at.reach),
                   most ? "yes" : "no", number(degrees(at.boom)), number(degrees(at.stick)),
                   number(at.hydraulic), field(at.circuit), number(at.tipping), number(at.rated()),
                   at.is_hydraulic() ? "hydraulic" : "tipping"});
    });
  return out;
}

nlohmann::json lift_json(const std::vector<LiftTable>& tables) {
  nlohmann::json out = {{"rig", "iso10567"}, {"version", NAVVY_VERSION}};
  out["lifts"] = nlohmann::json::array();
  for (const LiftTable& table : tables)
    over(table, [&](const LiftCapacity& at, bool most) {
      out["lifts"].push_back({{"machine", table.machine},
                              {"with_bucket", table.with_bucket},
                              {"swing_deg", degrees(at.heading)},
                              {"height_m", at.height},
                              {"reach_m", at.reach},
                              {"is_largest_reach", most},
                              {"boom_deg", degrees(at.boom)},
                              {"stick_deg", degrees(at.stick)},
                              {"hydraulic_kg", finite(at.hydraulic)},
                              {"circuit", at.circuit},
                              {"tipping_kg", finite(at.tipping)},
                              {"rated_kg", finite(at.rated())},
                              {"limit", at.is_hydraulic() ? "hydraulic" : "tipping"}});
    });
  return out;
}

}  // namespace navvy::cli
