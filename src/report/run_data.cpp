// SPDX-License-Identifier: Apache-2.0
#include "report/run_data.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base64.h"
#include "core/error.h"
#include "core/file.h"
#include "report/replay_reader.h"
#include "report/telemetry_reader.h"

namespace navvy::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostVideo = 2'000'000;             // bytes of videos in the page
constexpr std::size_t kMostPictures = 1'000'000;          // bytes of pictures in the page
constexpr std::size_t kMostText = std::size_t{64} << 20;  // bytes of a file read whole
constexpr std::size_t kMostFrames = 1500, kMostRows = 2000;
constexpr double kReplayShare = 0.7;  // of the bytes that frames and telemetry share

/// Reads one run.
class Reader {
 public:
  Reader(fs::path folder, fs::path page_folder)
      : folder_(std::move(folder)), page_folder_(std::move(page_folder)) {}

  json read(std::size_t most);

 private:
  std::string path(const char* name) const { return (folder_ / name).string(); }
  bool has(const char* name) const {
    std::error_code ignored;
    return fs::is_regular_file(folder_ / name, ignored);
  }
  void note(const std::string& text) { out_["notes"].push_back(text); }
  std::string text_of(const char* name);
  json object_of(const char* name);
  void read_replay_within(std::size_t most);
  void read_telemetry_within(std::size_t most);
  void read_paths();
  void read_videos();
  void read_pictures();
  std::string embedded(const fs::path& file) const {
    const std::vector<char> bytes = read_file(file.string(), kMostText);
    return base64(std::as_bytes(std::span(bytes)));
  }
  /// Returns the files of frames/ with one of these endings, in the order of their names.
  std::vector<fs::path> frames(const std::set<std::string>& endings) const;

  fs::path folder_, page_folder_;
  json out_;
};

std::string Reader::text_of(const char* name) {
  if (!has(name)) return "";
  try {
    const std::vector<char> bytes = read_file(path(name), kMostText);
    return {bytes.begin(), bytes.end()};
  } catch (const FileError& error) {
    note(error.what());
    return "";
  }
}

json Reader::object_of(const char* name) {
  const std::string text = text_of(name);
  json value = json::parse(text, nullptr, false);
  if (value.is_object()) return value;
  note(std::string(name) + (text.empty() ? " is missing" : " cannot be read"));
  return nullptr;
}

// The size is nearly proportional to the number of frames, so the second try mostly fits.
void Reader::read_replay_within(std::size_t most) {
  const std::string file = path("replay.jsonl");
  const std::size_t frames = count_frames(file);
  if (frames == 0) {
    note("There is no replay of this run: replay.jsonl is missing or has no frames");
    return;
  }
  std::size_t every = std::max<std::size_t>(1, (frames + kMostFrames - 1) / kMostFrames);
  json members;
  ReplayCounts counts;
  try {
    for (;;) {
      counts = read_replay(file, every, members);
      const std::size_t size = members.dump().size();
      if (size <= most || every >= frames) break;
      every = std::max(every + 1, static_cast<std::size_t>(std::ceil(
                                      1.05 * static_cast<double>(every) *
                                      static_cast<double>(size) / static_cast<double>(most))));
    }
  } catch (const Error& error) {
    note(std::string("The replay cannot be read: ") + error.what());
    return;
  }
  if (every > 1)
    note("Ground and machines are shown in one of " + std::to_string(every) + " frames out of " +
         std::to_string(counts.frames) + ", to keep the page small");
  if (counts.unread > 0)
    note(std::to_string(counts.unread) + " rows of replay.jsonl could not be read");
  if (!members["grid"].value("whole_site", true))
    note("Ground is shown within 2048 columns about the machines");
  out_.update(members);
}

void Reader::read_telemetry_within(std::size_t most) {
  const std::string file = path("telemetry.csv");
  const std::size_t rows = count_rows(file);
  if (rows == 0) {
    note("There is no telemetry of this run");
    return;
  }
  std::size_t every = std::max<std::size_t>(1, (rows + kMostRows - 1) / kMostRows);
  read_telemetry(file, every, out_);
  while (out_["telemetry"].dump().size() > most && every < rows)
    read_telemetry(file, every *= 2, out_);
  if (every > 1)
    note("Charts show one of " + std::to_string(every) + " rows out of " + std::to_string(rows) +
         ", to keep the page small");
}

// Columns: machine, step, plan, when, s, x, y, yaw, direction.
void Reader::read_paths() {
  std::istringstream in(text_of("paths.csv"));
  std::string row;
  std::getline(in, row);
  std::map<std::string, std::size_t> index;  // of the path by its machine, step and plan
  while (std::getline(in, row)) {
    std::vector<std::string> cells;
    std::istringstream words(row);
    for (std::string cell; std::getline(words, cell, ',');) cells.push_back(cell);
    if (cells.size() < 7) continue;
    const std::string key = cells[0] + "," + cells[1] + "," + cells[2];
    const auto [found, added] = index.try_emplace(key, out_["paths"].size());
    if (added) out_["paths"].push_back({{"machine", cells[0]}, {"points", json::array()}});
    out_["paths"][found->second]["points"].push_back(
        {std::strtod(cells[5].c_str(), nullptr), std::strtod(cells[6].c_str(), nullptr)});
  }
}

std::vector<fs::path> Reader::frames(const std::set<std::string>& endings) const {
  std::vector<fs::path> out;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder_ / "frames", failed))
    if (entry.is_regular_file(failed) && endings.contains(entry.path().extension().string()))
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

void Reader::read_videos() {
  std::size_t left = kMostVideo;
  for (const fs::path& file : frames({".mp4", ".webm"})) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(file, failed);
    if (failed || size == 0) continue;
    json video = {{"name", file.stem().string()}};
    if (size <= left) {
      video["type"] = "video/" + file.extension().string().substr(1);
      video["data"] = embedded(file);
      left -= static_cast<std::size_t>(size);
    } else {
      video["file"] = fs::relative(file, page_folder_, failed).generic_string();
      note("The video " + file.filename().string() + " is linked, not part of the page");
    }
    out_["videos"].push_back(std::move(video));
  }
}

// The last picture of each camera.
void Reader::read_pictures() {
  std::map<std::string, fs::path> last;
  for (const fs::path& file : frames({".png"})) {
    const std::string stem = file.stem().string();
    const std::size_t bar = stem.rfind('_');
    if (bar != std::string::npos) last[stem.substr(0, bar)] = file;
  }
  std::size_t left = kMostPictures;
  for (const auto& [camera, file] : last) {
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(file, failed);
    if (failed || size == 0 || size > left) continue;
    left -= static_cast<std::size_t>(size);
    out_["pictures"].push_back(
        {{"camera", camera}, {"time_s", nullptr}, {"type", "image/png"}, {"data", embedded(file)}});
  }
}

json Reader::read(std::size_t most) {
  out_ = empty_run("", folder_.string());
  out_["run"] = object_of("run.json");
  out_["summary"] = object_of("summary.json");
  const json& summary = out_["summary"];
  const auto word = [&](const char* key) {
    return summary.is_object() && summary.contains(key) && summary[key].is_string()
               ? summary[key].get<std::string>()
               : std::string();
  };
  out_["name"] = word("scenario").empty() ? folder_.filename().string() : word("scenario");
  const std::string status = word("status");
  out_["complete"] = !status.empty() && status != "running";
  if (!out_["complete"]) note("The run was killed or is still going on");
  out_["scene_text"] = text_of("scene.sdf");
  read_paths();
  read_videos();
  if (out_["videos"].empty()) read_pictures();
  const std::size_t taken = out_.dump(-1, ' ', false, json::error_handler_t::replace).size();
  const auto share = static_cast<double>(most > taken ? most - taken : most / 4);
  read_replay_within(static_cast<std::size_t>(kReplayShare * share));
  read_telemetry_within(static_cast<std::size_t>((1 - kReplayShare) * share));
  return std::move(out_);
}

}  // namespace

json empty_run(const std::string& name, const std::string& folder) {
  return {{"name", name},
          {"folder", folder},
          {"complete", false},
          {"notes", json::array()},
          {"run", nullptr},
          {"summary", nullptr},
          {"scene_text", ""},
          {"grid", nullptr},
          {"start", ""},
          {"design", nullptr},
          {"soils", json::array()},
          {"links", json::array()},
          {"cylinders", json::array()},
          {"forces", json::array()},
          {"frames", nullptr},
          {"paths", json::array()},
          {"phases", json::array()},
          {"telemetry", nullptr},
          {"videos", json::array()},
          {"pictures", json::array()}};
}

json run_data(const std::string& folder, const std::string& page_folder, std::size_t most) {
  std::error_code failed;
  fs::path path(folder);
  if (!fs::is_directory(path, failed) ||
      (!fs::exists(path / "run.json", failed) && !fs::exists(path / "summary.json", failed)))
    throw InputError(Fault{Fault::Severity::kError, folder, 0, "report", folder,
                           "is no folder of a run: it has neither run.json nor summary.json",
                           "name the folder that `navvy run` wrote (--out), e.g. out/trench"});
  if (path.filename().empty()) path = path.parent_path();
  return Reader(path, page_folder).read(most);
}

}  // namespace navvy::report
