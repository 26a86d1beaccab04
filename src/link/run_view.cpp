// SPDX-License-Identifier: Apache-2.0
#include "link/run_view.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "record/run_folder.h"
#include "report/live_page.h"
#include "report/page.h"

namespace navvy::link {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kOption = "--port";
constexpr std::size_t kMostSummary = std::size_t{64} << 20;
constexpr std::size_t kMostVideo = std::size_t{1} << 30;
/// Interval at which the folder is asked whether the run has ended [s].
constexpr double kCheck = 1;

/// Page of a run that has not recorded a frame yet; it asks again by itself.
constexpr const char* kWaiting =
    "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'\">"
    "<meta http-equiv=\"refresh\" content=\"1\"><link rel=\"icon\" href=\"data:,\">"
    "<title>navvy view</title></head>"
    "<body><p>The run has not recorded a frame yet. This page asks again every second.</p>"
    "<p>A run with --no-report records none.</p></body></html>\n";

/// Returns the members of summary.json; an empty object if it cannot be read.
json summary_of(const std::string& folder) {
  try {
    const std::vector<char> text = read_file(folder + "/summary.json", kMostSummary);
    json out = json::parse(text.begin(), text.end(), nullptr, false);
    if (out.is_object()) return out;
  } catch (const FileError&) {
    // Not written yet, or removed.
  }
  return json::object();
}

std::string word(const json& summary, const char* key) {
  const auto found = summary.find(key);
  return found != summary.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Returns true if a process holds the lock of the folder (record::RunFolder).
bool is_locked(const std::string& folder) {
  const std::string marker = folder + "/" + record::RunFolder::kMarker;
  const int file = ::open(marker.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return locked;
}

/// Returns a video of the run that its page links to, such as "frames/side.mp4".
std::optional<ViewFile> video(const std::string& folder, const std::string& path) {
  const fs::path name(path);
  const std::string ending = name.extension().string();
  if (name.parent_path() != "frames" || (ending != ".mp4" && ending != ".webm"))
    return std::nullopt;
  try {
    const std::vector<char> bytes = read_file(folder + "/" + path, kMostVideo);
    return ViewFile{"video/" + ending.substr(1), {bytes.begin(), bytes.end()}};
  } catch (const FileError&) {
    return std::nullopt;
  }
}

}  // namespace

RunView::RunView(std::string folder, int port) : folder_(std::move(folder)) {
  // A folder that is none of a run is refused with the message of its page.
  report::page_text({folder_}, folder_);
  ViewServer::require_port(kOption, port);
  server_ = std::make_unique<ViewServer>(
      kOption, port,
      ViewContent{[this] { return page(); },
                  [this] { return feed(); },
                  {},
                  [this](const std::string& path) { return video(folder_, path); }});
}

RunView::~RunView() {
  feed()->close("navvy view has ended.");
  server_->close();
}

bool RunView::is_running() const {
  return word(summary_of(folder_), "status") == "running" && is_locked(folder_);
}

std::string RunView::page() {
  if (!is_running()) return report::page_text({folder_}, folder_);
  const std::lock_guard<std::mutex> lock(mutex_);
  try {
    if (!follower_ || !follower_->is_current()) {
      follower_.emplace(folder_ + "/replay.jsonl");
      feed_->close("Another run writes to this folder now.");
      feed_ = std::make_shared<ViewFeed>();
      // The frames so far are not played again.
      follower_->step(*feed_, true);
    }
    const std::string name = word(summary_of(folder_), "scenario");
    return report::live_page(name.empty() ? "run" : name, follower_->header(),
                             {{"control", false}, {"inputs", json::array()}});
  } catch (const Error&) {
    follower_.reset();
    return kWaiting;
  }
}

std::shared_ptr<ViewFeed> RunView::feed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return feed_;
}

void RunView::step() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!follower_ || feed_->end()) return;
  follower_->step(*feed_);
  if (since_check_.seconds() < kCheck) return;
  since_check_.restart();
  end_if_over();
}

void RunView::end_if_over() {
  if (!follower_->is_current()) {
    feed_->close("Another run writes to this folder now.");
  } else if (!is_running()) {
    follower_->step(*feed_, true);
    const std::string status = word(summary_of(folder_), "status");
    feed_->close(status == "running" ? "The run was killed."
                                     : "The run has ended: " + status + ".");
  }
}

}  // namespace navvy::link
