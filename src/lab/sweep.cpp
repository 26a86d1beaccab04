// SPDX-License-Identifier: Apache-2.0
#include "lab/sweep.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"

namespace navvy::lab {
namespace {

std::string heading(const std::string& name, const std::string& unit) {
  return name + (unit.empty() ? "" : " [" + unit + "]");
}

/// Returns the axis of the plot: the first that varies.
std::size_t drawn_axis(const Sweep& sweep) {
  for (std::size_t i = 0; i < sweep.axes.size(); ++i)
    if (sweep.axes[i].values.size() > 1) return i;
  return 0;
}

/// Returns the name of a line of the plot: the values of its runs on the other varied axes.
std::string line_name(const Sweep& sweep, const SweepRun& run, std::size_t drawn) {
  std::string out;
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    if (i == drawn || sweep.axes[i].values.size() < 2) continue;
    out += (out.empty() ? "" : ", ") + sweep.axes[i].name + " " + short_text(run.at[i]);
  }
  return out.empty() ? "measured" : out;
}

/// Returns true if all values are equal.
bool same(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
}

}  // namespace

std::vector<std::string> listed(const std::string& option, const std::string& written) {
  // The list begins with one part, so that an empty text is an empty part and refused.
  std::vector<std::string> out{""};
  for (const char c : written) {
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  }
  for (const std::string& part : out)
    if (part.empty())
      throw InputError(Fault{Fault::Severity::kError, "", 0, option, written,
                             "a value or a list of values",
                             "write them with commas and no space between, as 0.05,0.15"});
  return out;
}

std::vector<std::vector<double>> combinations(const std::vector<SweepAxis>& axes) {
  // One empty combination makes the one run of an experiment without axes.
  std::vector<std::vector<double>> out{{}};
  for (const SweepAxis& axis : axes) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& start : out)
      for (const double value : axis.values) {
        longer.push_back(start);
        longer.back().push_back(value);
      }
    out = std::move(longer);
  }
  return out;
}

std::vector<std::string> shown_results(const Rig& rig, const Report& report) {
  std::vector<std::string> out;
  for (const std::string& name : rig.headline)
    if (report.find(name) != nullptr) out.push_back(name);
  // A rig without a headline shows its first result.
  if (out.empty() && !report.results.empty()) out.push_back(report.results.front().name);
  return out;
}

std::vector<std::vector<std::string>> table_of(const Rig& rig, const Sweep& sweep) {
  std::vector<std::vector<std::string>> out(1);
  if (sweep.runs.empty()) return out;
  for (const SweepAxis& axis : sweep.axes) out[0].push_back(heading(axis.name, axis.unit));
  // All runs are of one rig, so the first report decides the columns; a result that another report
  // lacks is shown as nan.
  const std::vector<std::string> shown = shown_results(rig, sweep.runs.front().report);
  for (const std::string& name : shown)
    out[0].push_back(heading(name, sweep.runs.front().report.find(name)->unit));
  out[0].insert(out[0].end(), {"steps", "s", "tolerances"});
  for (const SweepRun& run : sweep.runs) {
    std::vector<std::string> row;
    for (const double value : run.at) row.push_back(short_text(value));
    for (const std::string& name : shown) {
      const Quantity* q = run.report.find(name);
      row.push_back(q == nullptr || std::isnan(q->measured) ? "nan" : short_text(q->measured));
    }
    row.push_back(std::to_string(run.report.steps));
    // Tenths of a second: wall times vary by more from run to run.
    row.push_back(short_text(std::round(10 * run.report.wall_time) / 10));
    row.emplace_back(run.report.outside_tolerance() ? "outside" : "");
    out.push_back(std::move(row));
  }
  return out;
}

std::string text_of(const std::vector<std::vector<std::string>>& table) {
  std::vector<std::size_t> width;
  for (const auto& row : table) {
    width.resize(std::max(width.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::string out;
  for (const auto& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i)
      out += std::string(width[i] - row[i].size() + (i > 0 ? 2 : 0), ' ') + row[i];
    out += '\n';
  }
  return out;
}

Plot plot_of(const Rig& rig, const Sweep& sweep) {
  Plot out;
  out.title = "navvy lab " + rig.name;
  if (sweep.runs.empty() || sweep.axes.empty()) return out;
  const std::size_t drawn = drawn_axis(sweep);
  const std::string name = shown_results(rig, sweep.runs.front().report).front();
  out.x_label = heading(sweep.axes[drawn].name, sweep.axes[drawn].unit);
  out.y_label = heading(name, sweep.runs.front().report.find(name)->unit);
  // By name, in the order of the runs.
  std::map<std::string, std::size_t> lines;
  std::vector<double> expected, low, high;
  for (const SweepRun& run : sweep.runs) {
    const Quantity* q = run.report.find(name);
    if (q == nullptr) continue;
    const std::string title = line_name(sweep, run, drawn);
    const auto [found, fresh] = lines.emplace(title, out.lines.size());
    if (fresh) out.lines.push_back({title, {}, {}});
    out.lines[found->second].x.push_back(run.at[drawn]);
    out.lines[found->second].y.push_back(q->measured);
    expected.push_back(q->expected), low.push_back(q->low), high.push_back(q->high);
  }
  // NaN is not equal to itself: a value that no run has is not drawn.
  // The result was found in the first report, so none of the lists is empty.
  if (same(expected)) out.expected.push_back(expected.front());
  if (same(low) && same(high)) out.tolerances.emplace_back(low.front(), high.front());
  return out;
}

}  // namespace navvy::lab
