// SPDX-License-Identifier: Apache-2.0
// `navvy score` and `navvy compare`: the score of a run, and of two runs side by side.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "core/error.h"
#include "core/file.h"
#include "core/printable.h"

namespace navvy::cli {
namespace {

using nlohmann::json;

/// Largest summary that is read [bytes]; a day of cycles takes a tenth of it.
constexpr std::uintmax_t kMostBytes = 256u << 20;

[[noreturn]] void refuse(const std::string& file, const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, file, 0, "score", value, rule, remedy});
}

/// Returns the summary of a run, given its folder or its summary.json.
json read_summary(const std::string& run) {
  namespace fs = std::filesystem;
  std::error_code error;
  const std::string file =
      fs::is_directory(run, error) ? (fs::path(run) / "summary.json").string() : run;
  if (!fs::is_regular_file(file, error))
    refuse(file, run, "is no folder of a run: it has no summary.json",
           "name the folder that `navvy run` wrote (--out), e.g. out/trench");
  if (fs::file_size(file, error) > kMostBytes || error)
    refuse(file, "", "a summary of more than 256 MiB is not read", "name the folder of a run");
  const std::vector<char> bytes = read_file(file);
  json summary = json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (summary.is_discarded() || !summary.is_object())
    refuse(file, "", "is not the JSON object of a summary", "run the scene again");
  if (!summary.contains("score") || !summary["score"].is_object())
    refuse(file, "", "has no score: a version of Navvy before the score wrote it",
           "run the scene again");
  return summary;
}

/// A value of a score with its path, such as "shape/completion".
using Values = std::vector<std::pair<std::string, double>>;

/// Appends all numbers of `value` with their paths.
void collect(const json& value, const std::string& path, Values& out) {
  if (value.is_number()) out.emplace_back(path, value.get<double>());
  if (value.is_object())
    for (const auto& [key, child] : value.items())
      collect(child, path.empty() ? key : path + "/" + key, out);
  if (!value.is_array()) return;
  for (std::size_t i = 0; i < value.size(); ++i) {
    // Machines go by their names, below the key of their list: a name may be that of another key.
    const json& child = value[i];
    const bool named =
        child.is_object() && child.contains("machine") && child["machine"].is_string();
    collect(child, path + "/" + (named ? child["machine"].get<std::string>() : std::to_string(i)),
            out);
  }
}

Values values_of(const json& summary) {
  Values out;
  collect(summary["score"], "", out);
  return out;
}

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// Prints the judgements of the goals.
void print_goals(const json& goals) {
  for (const json& goal : goals) {
    const bool least = goal.contains("at_least");
    // A value that could not be measured has a reason instead.
    const std::string is = goal.contains("value") ? "is " + number(goal.at("value").get<double>())
                                                  : printable(goal.at("reason").get<std::string>());
    std::printf("goal %s: %s, %s, wanted at %s %s\n",
                printable(goal.at("goal").get<std::string>()).c_str(),
                goal.at("met").get<bool>() ? "met" : "MISSED", is.c_str(), least ? "least" : "most",
                number(goal.at(least ? "at_least" : "at_most").get<double>()).c_str());
  }
}

/// Prints the score of a run; returns the exit status that its goals and events decide.
int score(const std::string& run, bool as_json) {
  const json summary = read_summary(run);
  const json goals = summary.value("goals", json::array());
  if (as_json) {
    json out = {{"score", summary["score"]}};
    for (const char* key : {"goals", "forbidden_event", "status", "scenario"})
      if (summary.contains(key)) out[key] = summary[key];
    std::printf("%s\n", out.dump(2, ' ', false, json::error_handler_t::replace).c_str());
  } else {
    for (const auto& [name, value] : values_of(summary))
      std::printf("%-44s %s\n", printable(name).c_str(), number(value).c_str());
    print_goals(goals);
  }
  if (summary.contains("forbidden_event")) return kForbidden;
  const bool met = std::all_of(goals.begin(), goals.end(),
                               [](const json& goal) { return goal.at("met").get<bool>(); });
  return met ? kOk : kMissedGoal;
}

/// Runs an action on summaries that others may have changed.
template <class Use>
int reading(const std::string& file, const Use& use) {
  try {
    return use();
  } catch (const json::exception&) {
    refuse(file, "", "has a value of another type than a summary has", "run the scene again");
  }
}

/// Prints the scores of two runs with their differences.
int compare(const std::string& first, const std::string& second, bool as_json) {
  const Values a = values_of(read_summary(first)), b = values_of(read_summary(second));
  const auto find = [](const Values& in, const std::string& name) {
    return std::find_if(in.begin(), in.end(), [&](const auto& one) { return one.first == name; });
  };
  std::vector<std::string> names;
  for (const auto& one : a) names.push_back(one.first);
  for (const auto& one : b)
    if (find(a, one.first) == a.end()) names.push_back(one.first);
  json out = json::array();
  if (!as_json) std::printf("%-44s %14s %14s %14s %9s\n", "value", "A", "B", "B - A", "share");
  for (const std::string& name : names) {
    const auto in_a = find(a, name), in_b = find(b, name);
    const bool both = in_a != a.end() && in_b != b.end();
    json row = {{"value", name}};
    if (in_a != a.end()) row["a"] = in_a->second;
    if (in_b != b.end()) row["b"] = in_b->second;
    if (both) row["difference"] = in_b->second - in_a->second;
    const auto text = [&](const char* key) {
      return row.contains(key) ? number(row[key].get<double>()) : std::string("-");
    };
    const bool has_share = both && in_a->second != 0;
    const std::string share =
        has_share ? number(100 * (in_b->second / in_a->second - 1)) + " %" : "-";
    if (!as_json)
      std::printf("%-44s %14s %14s %14s %9s\n", printable(name).c_str(), text("a").c_str(),
                  text("b").c_str(), text("difference").c_str(), share.c_str());
    out.push_back(std::move(row));
  }
  if (as_json) std::printf("%s\n", out.dump(2, ' ', false, json::error_handler_t::replace).c_str());
  return kOk;
}

}  // namespace

void add_score(CLI::App& app, Action& action) {
  auto run = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "score", "print the score of a run: volumes, shape, cycles, energy; and its goals");
  command->add_option("run", *run, "folder of a run, or its summary.json")->required();
  command->add_flag("--json", *as_json, "print JSON");
  command->footer(
      "Exit status 9 if a goal of the scene (navvy:goals) is missed, 8 after a forbidden event.");
  command->callback([run, as_json, &action] {
    action = [run, as_json] { return reading(*run, [&] { return score(*run, *as_json); }); };
  });
}

void add_compare(CLI::App& app, Action& action) {
  auto runs = std::make_shared<std::array<std::string, 2>>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("compare", "compare the scores of two runs");
  command->add_option("a", (*runs)[0], "folder of the first run, or its summary.json")->required();
  command->add_option("b", (*runs)[1], "folder of the second run, or its summary.json")->required();
  command->add_flag("--json", *as_json, "print JSON");
  command->callback([runs, as_json, &action] {
    action = [runs, as_json] { return compare((*runs)[0], (*runs)[1], *as_json); };
  });
}

}  // namespace navvy::cli
