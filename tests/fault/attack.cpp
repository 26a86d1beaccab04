// SPDX-License-Identifier: Apache-2.0
#include "fault/attack.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "paths.h"
#include "process.h"
#include "text_of.h"

namespace navvy::fault {
namespace {

namespace fs = std::filesystem;

using test::text_of;

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Returns true if all rows have as many cells as the header.
bool is_table(const std::string& text) {
  if (!ends_with(text, "\n")) return false;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const auto columns = std::count(line.begin(), line.end(), ',');
  while (std::getline(lines, line))
    if (std::count(line.begin(), line.end(), ',') != columns) return false;
  return true;
}

/// Returns true for a little-endian file whose directory is within it.
bool is_geotiff(const std::string& text) {
  if (text.size() < 8 || text.rfind("II", 0) != 0) return false;
  std::uint32_t directory = 0;
  std::memcpy(&directory, text.data() + 4, sizeof directory);
  return directory >= 8 && directory < text.size();
}

std::vector<std::pair<std::string, std::string>> environment_of(const Attack& with) {
  auto out = with.environment;
  if (!with.fault.empty()) out.emplace_back("NAVVY_FAULT", with.fault);
  if (!with.hang.empty()) out.emplace_back("NAVVY_HANG", with.hang);
  if (!with.abort.empty()) out.emplace_back("NAVVY_ABORT", with.abort);
  out.emplace_back("LD_PRELOAD", NAVVY_FAULT_SHIM);
  return out;
}

/// Checks a run whose device had no memory: status 3, a message, and a summary with a balanced
/// ledger. A run that ended before its summary existed is accepted.
std::string broken_by_full_device(const nlohmann::json& summary, const Outcome& got) {
  if (got.status != 3) return "ended with " + std::to_string(got.status);
  if (got.said.find("clCreateBuffer") == std::string::npos) return "does not name what failed";
  if (got.said.find("incomplete") != std::string::npos) return "its results are incomplete";
  if (got.summary.empty()) return "";
  if (got.summary != "failed") return "the summary says '" + got.summary + "'";
  const auto units = summary.value("/mass_ledger/error_units"_json_pointer, nlohmann::json(-1));
  return units == 0 ? "" : "the mass ledger is open: " + units.dump();
}

/// Detects whether a process still makes progress: on a loaded machine it may get one second of
/// processor time in minutes, whereas a hung process uses none, or more than the limit.
class Patience {
 public:
  Patience(pid_t process, double limit) : process_(process), limit_(limit) {}
  bool ended(double spent) {
    if (spent < until_ + limit_) return false;
    const double had = processor_time(process_);
    const bool gets_on = had > had_ + kStirs && had < limit_;
    until_ = spent;
    had_ = had;
    return !gets_on;
  }

 private:
  static constexpr double kStirs = 0.1;  // [s] of a processor
  pid_t process_;
  double limit_, until_ = 0, had_ = 0;
};

/// Waits for a process, kills it at `kill_after` [s] if that is not 0, else when it has hung for
/// `patience` [s]. Sets its exit status, or minus its signal; returns true if it was killed.
bool wait_or_kill(pid_t child, double kill_after, double patience, int& status) {
  const auto begun = std::chrono::steady_clock::now();
  const auto spent = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  };
  Patience left(child, patience);
  const auto over = [&] { return kill_after > 0 ? spent() >= kill_after : left.ended(spent()); };
  int raw = 0;
  pid_t ended = 0;
  while ((ended = waitpid(child, &raw, WNOHANG)) == 0 && !over())
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  if (ended == 0) kill(child, SIGKILL);
  if (ended == 0) waitpid(child, &raw, 0);
  status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw);
  return ended == 0;
}

}  // namespace

double processor_time(pid_t process) {
  const std::string text = text_of("/proc/" + std::to_string(process) + "/stat");
  // After the name, which may contain anything but ends with the last bracket, the 12th and 13th
  // word.
  std::istringstream words(text.substr(std::min(text.rfind(')') + 1, text.size())));
  std::string word;
  for (int i = 0; i < 11; ++i) words >> word;
  double user = 0, system = 0;
  words >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

std::vector<std::string> small_run(bool drawing) {
  std::vector<std::string> out{"run",          navvy::source_dir() + "/scenarios/bucket_path.sdf",
                               "--duration",   "0.2",
                               "--hash-every", "0.1",
                               "--device",     "cpu"};
  if (drawing)
    out.insert(out.end(), {"--set", "camera.rate_hz=10"});
  else
    out.emplace_back("--no-render");
  return out;
}

std::string broken_files(const std::string& out, bool killed) {
  if (!fs::exists(out)) return "";
  for (const auto& entry : fs::recursive_directory_iterator(out)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().filename().string(), text = text_of(entry.path());
    bool whole = true;
    if (ends_with(name, ".json"))
      whole = nlohmann::json::accept(text);
    else if (ends_with(name, ".csv"))
      whole = is_table(killed ? text.substr(0, text.rfind('\n') + 1) : text);
    else if (ends_with(name, ".tif"))
      whole = is_geotiff(text);
    else if (ends_with(name, ".png"))
      whole = ends_with(text, std::string("IEND\xAE\x42\x60\x82", 8));
    else if (ends_with(name, ".sdf"))
      whole = ends_with(text, "</sdf>\n");
    if (!whole) return name + " is not whole";
  }
  return "";
}

Outcome attack(const std::string& folder, const std::vector<std::string>& arguments,
               const Attack& with, const std::string& hash) {
  const std::string out = folder + "/out";
  fs::create_directories(folder);
  fs::remove_all(out);
  std::vector<std::string> all = arguments;
  all.insert(all.end(), {"--out", out});
  const auto begun = std::chrono::steady_clock::now();
  const pid_t child = test::start(
      {NAVVY_PROGRAM, all, environment_of(with), "/dev/null", "/dev/null", folder + "/stderr"});
  Outcome got;
  const bool cut = wait_or_kill(child, with.kill_after, with.patience, got.status);
  got.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  got.said = text_of(folder + "/stderr");
  const auto summary = nlohmann::json::parse(text_of(out + "/summary.json"), nullptr, false);
  if (summary.is_object()) {
    got.summary = summary.value("status", "");
    if (summary.contains("state_hash") && summary["state_hash"].is_string())
      got.hash = summary["state_hash"];
  }
  const bool killed = with.kill_after > 0 && cut;
  static const std::set<int> kTable = {0, 1, 2, 3, 4, 5, 6, 130};
  got.broken = broken_files(out, killed);
  if (!got.broken.empty()) return got;
  if (killed) return got;
  if (cut)
    got.broken = "hung for " + std::to_string(static_cast<int>(with.patience)) + " s";
  else if (kTable.count(got.status) == 0)
    got.broken = "ended with " + std::to_string(got.status);
  else if (got.status != 0 && got.said.empty())
    got.broken = "printed nothing";
  else if (got.said.find("internal error") != std::string::npos)
    got.broken = "an internal error";
  else if (with.fault.rfind("buffer", 0) == 0)
    got.broken = broken_by_full_device(summary, got);
  else if (got.summary == "running")
    got.broken = "the summary still says running";
  // --duration ends it early.
  else if (got.status == 0 && got.summary != "finished" && got.summary != "incomplete")
    got.broken = "status 0 and a summary that says '" + got.summary + "'";
  else if (got.status == 0 && !hash.empty() && got.hash != hash)
    got.broken = "another result";
  return got;
}

std::vector<std::pair<std::string, long>> count_calls(const std::string& folder,
                                                      const std::vector<std::string>& arguments,
                                                      const Attack& with) {
  Attack counting = with;
  fs::create_directories(folder);
  const std::string file = folder + "/counts";
  fs::remove(file);
  counting.environment.emplace_back("NAVVY_FAULT_COUNT", file);
  attack(folder, arguments, counting);
  std::vector<std::pair<std::string, long>> out;
  std::istringstream lines(text_of(file));
  std::string name;
  long count = 0;
  // Programs that the driver starts print their counts too, earlier; the last lines, one per kind
  // of call, are those of navvy.
  while (lines >> name >> count) out.emplace_back(name, count);
  if (out.size() > kKinds) out.erase(out.begin(), out.end() - static_cast<std::ptrdiff_t>(kKinds));
  return out;
}

}  // namespace navvy::fault
