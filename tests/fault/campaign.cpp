// SPDX-License-Identifier: Apache-2.0
// The whole campaign (`./dev fault`): every open, write, fsync and rename of a small run fails
// once, as does every buffer on the device, some hundred of the program's allocations, and some
// hundred kills hit it while it compiles and draws. Resumes where it stopped; its table is a CSV.
//
// An attack costs the start of the program, three tenths of a second of a core: the run itself is a
// fifth of that, and its kernels come from a cache that all attacks of a lane share unless the
// attack is on compiling.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/random.h"
#include "core/stopwatch.h"
#include "fault/attack.h"

namespace navvy::fault {
namespace {

namespace fs = std::filesystem;

/// Number of the program's own allocations that fail, spread evenly over the run.
constexpr long kAllocations = 500;
/// Number of kills of each kind.
constexpr int kKills = 250;
/// Number of attacks of a lane after which a run without an attack must still succeed.
constexpr int kLookAgain = 25;

/// Table of attacks, which are identified by name in this file and in the table.
class Table {
 public:
  explicit Table(std::string path) : path_(std::move(path)) {
    std::ifstream in(path_);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) done_.insert(line.substr(0, line.find(',')));
    if (done_.empty()) std::ofstream(path_) << "attack,status,summary,seconds,broken\n";
  }
  bool has(const std::string& name) const { return done_.count(name) > 0; }
  void add(const std::string& name, const Outcome& got) {
    std::ofstream(path_, std::ios::app) << name << ',' << got.status << ',' << got.summary << ','
                                        << got.seconds << ',' << got.broken << '\n';
    done_.insert(name);
  }
  /// Prints counts by kind of attack and by status, and the failures. Returns true if all survived.
  bool report() const;

 private:
  std::string path_;
  std::set<std::string> done_;
};

bool Table::report() const {
  std::ifstream in(path_);
  std::string line;
  std::getline(in, line);
  struct Row {
    int tried = 0, survived = 0;
    std::map<std::string, int> statuses;
  };
  std::map<std::string, Row> rows;
  bool all = true;
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    if (cells.size() < 4) continue;
    Row& row = rows[cells[0].substr(0, cells[0].find(':'))];
    ++row.tried;
    row.survived += cells.size() == 4;
    ++row.statuses[cells[1]];
    if (cells.size() == 4) continue;
    all = false;
    std::printf("  %s: %s (status %s)\n", cells[0].c_str(), cells[4].c_str(), cells[1].c_str());
  }
  for (const auto& [kind, row] : rows) {
    std::printf("%-14s %5d tried, %5d survived;", kind.c_str(), row.tried, row.survived);
    for (const auto& [status, count] : row.statuses)
      std::printf(" status %s: %d", status.c_str(), count);
    std::printf("\n");
  }
  return all;
}

/// Runs attacks in sequence, in a folder and with a kernel cache of its own.
class Lane {
 public:
  /// @throws std::runtime_error if the run fails without an attack.
  explicit Lane(const std::string& folder) : plain_(small_run(false)), drawing_(small_run(true)) {
    enter(folder);
    sound_ = require_sound(plain_, none_);
    warm_ = require_sound(drawing_, none_);
    compiling_ = require_sound(drawing_, cold_);
  }
  /// Creates a lane beside `first`, with a copy of its kernels.
  Lane(const std::string& folder, const Lane& first) : Lane(first) {
    enter(folder);
    fs::remove_all(folder_ + "/cache");
    fs::copy(first.folder_ + "/cache", folder_ + "/cache", fs::copy_options::recursive);
  }
  /// Names of all attacks.
  std::vector<std::string> all() const;
  Outcome operator()(const std::string& name);

 private:
  void enter(const std::string& folder) {
    folder_ = folder;
    fs::create_directories(folder_);
    fs::remove_all(folder_ + "/cold");
    // One worker of the driver: counts are then repeatable, and a lane uses at most one core.
    none_.environment = {{"POCL_CACHE_DIR", folder_ + "/cache"}, {"POCL_MAX_PTHREAD_COUNT", "1"}};
    cold_.environment = {{"POCL_CACHE_DIR", folder_ + "/cold"}, {"POCL_MAX_PTHREAD_COUNT", "1"}};
  }
  Outcome require_sound(const std::vector<std::string>& arguments, const Attack& with) const {
    Outcome out = attack(folder_, arguments, with);
    if (out.status == 0 && out.broken.empty()) return out;
    throw std::runtime_error("the run fails without any attack (status " +
                             std::to_string(out.status) + "): " + out.broken + "\n" + out.said);
  }
  Outcome killed(bool compiling, std::uint64_t number);

  std::string folder_;
  std::vector<std::string> plain_, drawing_;
  Attack none_, cold_;
  Outcome sound_, warm_, compiling_;
  int tried_ = 0;
};

std::vector<std::string> Lane::all() const {
  const std::map<std::string, std::vector<std::string>> codes = {
      {"open", {"EMFILE"}},          {"write", {"ENOSPC", "EIO"}}, {"fsync", {"EIO", "ENOSPC"}},
      {"rename", {"EIO", "ENOSPC"}}, {"new", {"ENOMEM"}},          {"buffer", {"ENOMEM"}}};
  std::vector<std::string> out;
  for (const auto& [call, count] : count_calls(folder_, plain_, none_)) {
    const long step = call == "new" ? std::max(1L, count / kAllocations) : 1;
    const auto& names = codes.at(call);
    for (long n = 1; n <= count; n += step)
      out.push_back(call + ":" + std::to_string(n) + ":" +
                    names[static_cast<std::size_t>(n) % names.size()]);
  }
  for (int i = 0; i < kKills; ++i) {
    out.push_back("kill-compiling:" + std::to_string(i));
    out.push_back("kill-drawing:" + std::to_string(i));
  }
  return out;
}

/// Kills at a time given by the number. If the run ended before, because the machine was less busy,
/// it is run again and killed earlier.
Outcome Lane::killed(bool compiling, std::uint64_t number) {
  const Outcome& whole = compiling ? compiling_ : warm_;
  Attack with = compiling ? cold_ : none_;
  with.kill_after = Random(number).uniform(0.02, 1.0) * whole.seconds;
  Outcome got;
  for (int i = 0; i < 4; ++i) {
    if (compiling) fs::remove_all(folder_ + "/cold");
    got = attack(folder_, drawing_, with, whole.hash);
    if (got.status == -SIGKILL || !got.broken.empty()) break;
    with.kill_after /= 2;
  }
  return got;
}

Outcome Lane::operator()(const std::string& name) {
  Outcome got;
  if (name.rfind("kill", 0) == 0) {
    got = killed(name.rfind("kill-compiling", 0) == 0, std::stoul(name.substr(name.find(':') + 1)));
  } else {
    Attack with = none_;
    with.fault = name;
    got = attack(folder_, plain_, with, sound_.hash);
  }
  // Files that the attack left in the kernel cache must not spoil the next run.
  if (got.broken.empty() && ++tried_ % kLookAgain == 0) {
    const Outcome after = attack(folder_, plain_, none_, sound_.hash);
    if (after.status != 0 || !after.broken.empty()) got.broken = "the run after it fails";
  }
  return got;
}

/// Orders attacks by one of each kind in turn, and within a kind such that early ones are spread
/// over the run: a campaign stopped early has a fair share of each, and all of the few decisive
/// calls (rename, fsync).
std::vector<std::string> in_turn(const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::string>> kinds;
  for (const std::string& name : names) kinds[name.substr(0, name.find(':'))].push_back(name);
  Random random(1);
  for (auto& [kind, list] : kinds)
    for (std::size_t i = list.size(); i > 1; --i)
      std::swap(list[i - 1],
                list[static_cast<std::size_t>(random.uniform(0, static_cast<double>(i)))]);
  std::vector<std::string> out;
  for (std::size_t i = 0; out.size() < names.size(); ++i)
    for (const auto& [kind, list] : kinds)
      if (i < list.size()) out.push_back(list[i]);
  return out;
}

int run(const std::string& folder, long most, int lanes) {
  fs::create_directories(folder);
  Table table(folder + "/results.csv");
  // Created before any thread: a failure here fails the whole campaign.
  std::vector<std::unique_ptr<Lane>> made;
  made.push_back(std::make_unique<Lane>(folder + "/0"));
  for (int i = 1; i < lanes; ++i)
    made.push_back(std::make_unique<Lane>(folder + "/" + std::to_string(i), *made[0]));
  std::vector<std::string> due = in_turn(made[0]->all());
  const std::size_t all = due.size();
  due.erase(std::remove_if(due.begin(), due.end(),
                           [&](const std::string& name) { return table.has(name); }),
            due.end());
  if (most > 0) due.resize(std::min(due.size(), static_cast<std::size_t>(most)));
  std::printf("%zu attacks, %zu of them this time\n", all, due.size());
  std::mutex one;
  std::size_t next = 0;
  const Stopwatch watch;
  const auto walk = [&](Lane& lane) {
    while (true) {
      std::string name;
      {
        const std::lock_guard<std::mutex> lock(one);
        if (next == due.size()) return;
        name = due[next++];
      }
      const Outcome got = lane(name);
      const std::lock_guard<std::mutex> lock(one);
      table.add(name, got);
      if (!got.broken.empty())
        std::printf("%s: %s, status %d\n%s\n", name.c_str(), got.broken.c_str(), got.status,
                    got.said.c_str());
      if (next % 100 == 0)
        std::printf("%zu of %zu, %.1f s each\n", next, due.size(), watch.seconds() / double(next));
      std::fflush(stdout);
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < lanes; ++i)
    threads.emplace_back([&, i] { walk(*made[static_cast<std::size_t>(i)]); });
  walk(*made[0]);
  for (std::thread& thread : threads) thread.join();
  return table.report() ? 0 : 1;
}

}  // namespace
}  // namespace navvy::fault

int main(int argc, char** argv) {
  if (argc < 2) {
    std::printf(
        "usage: navvy_fault_campaign FOLDER [N [LANES]]: N attacks at most, or all (0); so many "
        "side by side\n");
    return 2;
  }
  try {
    return navvy::fault::run(argv[1], argc > 2 ? std::stol(argv[2]) : 0,
                             argc > 3 ? std::stoi(argv[3]) : 1);
  } catch (const std::exception& error) {
    std::printf("%s\n", error.what());
    return 1;
  }
}
