// SPDX-License-Identifier: Apache-2.0
// The whole campaign (`./dev fault`): every open, write, fsync and rename of a small run fails once, some hundred times
// our own memory, some hundred kills while it compiles and draws. Goes on where it stopped; its table stands in a CSV.
#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "core/random.h"
#include "fault/attack.h"

namespace navvy::fault {
namespace {

namespace fs = std::filesystem;

/// What was tried is known by its name, in this file and in the table.
struct Table {
  explicit Table(const std::string& path) : path_(path) {
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) done_.insert(line.substr(0, line.find(',')));
    if (done_.empty()) std::ofstream(path) << "attack,status,summary,seconds,broken\n";
  }
  bool has(const std::string& name) const { return done_.count(name) > 0; }
  void add(const std::string& name, const Outcome& got) {
    std::ofstream(path_, std::ios::app) << name << ',' << got.status << ',' << got.summary << ',' << got.seconds << ','
                                        << got.broken << '\n';
    done_.insert(name);
  }

 private:
  std::string path_;
  std::set<std::string> done_;
};

/// Counts of a table by kind of attack and by status.
void tell(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  struct Row {
    int tried = 0, survived = 0;
    std::map<std::string, int> statuses;
  };
  std::map<std::string, Row> rows;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    if (cells.size() < 4) continue;
    Row& row = rows[cells[0].substr(0, cells[0].find(':'))];
    ++row.tried;
    row.survived += cells.size() == 4;
    ++row.statuses[cells[1]];
    if (cells.size() > 4) std::printf("  %s: %s (status %s)\n", cells[0].c_str(), cells[4].c_str(), cells[1].c_str());
  }
  for (const auto& [kind, row] : rows) {
    std::printf("%-14s %5d tried, %5d survived;", kind.c_str(), row.tried, row.survived);
    for (const auto& [status, count] : row.statuses) std::printf(" status %s: %d", status.c_str(), count);
    std::printf("\n");
  }
}

int run(const std::string& folder, long most) {
  fs::create_directories(folder);
  Table table(folder + "/results.csv");
  const std::vector<std::string> plain = small_run(false), drawing = small_run(true);
  Attack none;
  none.environment = {{"POCL_CACHE_DIR", folder + "/cache"}};
  const Outcome sound = attack(folder, plain, none);
  if (!sound.broken.empty() || sound.status != 0) {
    std::printf("the run fails without any attack (status %d): %s\n%s", sound.status, sound.broken.c_str(),
                sound.said.c_str());
    return 1;
  }
  const Outcome warm = attack(folder, drawing, none);
  std::vector<std::string> due;
  const std::map<std::string, std::vector<std::string>> codes = {{"open", {"EMFILE"}},
                                                                 {"write", {"ENOSPC", "EIO"}},
                                                                 {"fsync", {"EIO", "ENOSPC"}},
                                                                 {"rename", {"EIO", "ENOSPC"}},
                                                                 {"new", {"ENOMEM"}}};
  for (const auto& [call, count] : count_calls(folder, plain, none)) {
    const long step = call == "new" ? std::max(1L, count / 500) : 1;
    const auto& names = codes.at(call);
    for (long n = 1; n <= count; n += step)
      due.push_back(call + ":" + std::to_string(n) + ":" + names[static_cast<std::size_t>(n) % names.size()]);
  }
  for (int i = 0; i < 250; ++i) {
    due.push_back("kill-compiling:" + std::to_string(i));
    due.push_back("kill-drawing:" + std::to_string(i));
  }
  // In an order that looks everywhere early: whoever stops after a part has seen a fair share of all.
  Random random(1);
  for (std::size_t i = due.size(); i > 1; --i)
    std::swap(due[i - 1], due[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
  long tried = 0;
  for (const std::string& name : due) {
    if (table.has(name)) continue;
    if (most > 0 && tried == most) break;
    ++tried;
    Attack with = none;
    Outcome got;
    if (name.rfind("kill", 0) == 0) {
      const bool compiling = name.rfind("kill-compiling", 0) == 0;
      if (compiling) {
        with.environment = {{"POCL_CACHE_DIR", folder + "/cold"}};
        fs::remove_all(folder + "/cold");
      }
      with.kill_after = random.uniform(0.05, 1.0) * (compiling ? 4 * sound.seconds : warm.seconds);
      got = attack(folder, drawing, with, warm.hash);
    } else {
      with.fault = name;
      got = attack(folder, plain, with, sound.hash);
    }
    // What the attack has left in the kernels' cache must not spoil the next run.
    if (got.broken.empty() && tried % 25 == 0) {
      const Outcome after = attack(folder, plain, none, sound.hash);
      if (after.status != 0 || !after.broken.empty()) got.broken = "the run after it fails";
    }
    table.add(name, got);
    if (!got.broken.empty()) {
      std::printf("%s: %s, status %d\n%s\n", name.c_str(), got.broken.c_str(), got.status, got.said.c_str());
      std::fflush(stdout);
    }
  }
  std::printf("%ld of %zu attacks this time\n", tried, due.size());
  tell(folder + "/results.csv");
  return 0;
}

}  // namespace
}  // namespace navvy::fault

int main(int argc, char** argv) {
  if (argc < 2) {
    std::printf("usage: navvy_fault_campaign FOLDER [N]: N attacks at most, or all\n");
    return 2;
  }
  return navvy::fault::run(argv[1], argc > 2 ? std::stol(argv[2]) : 0);
}
