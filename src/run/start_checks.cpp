// SPDX-License-Identifier: Apache-2.0
#include "run/start_checks.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "core/sealed.h"
#include "record/run_folder.h"

namespace navvy::run {
namespace {

[[noreturn]] void refuse(const char* option, const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, option, value, rule, remedy});
}

}  // namespace

std::string short_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// A pipe or a folder is refused as such; a missing file gets a hint how snapshots are made.
void check_resume(const std::string& path) {
  if (path.empty()) return;
  try {
    require_regular(path);
  } catch (const FileError& error) {
    refuse("--resume", path, error.what(), "name the file of a snapshot");
  }
  // Opened as well, since permissions are only known by trying.
  if (std::ifstream(path).is_open()) return;
  refuse(
      "--resume", path, "no such snapshot, or it cannot be read",
      "--snapshot FILE --snapshot-at T writes one; a run that failed leaves failed.snapshot among "
      "its results");
}

void check_snapshot(const std::string& path, const std::string& folder) {
  if (path.empty()) return;
  std::error_code code;
  // An empty file holds nothing that could be lost.
  if (!is_sealed(path) && std::filesystem::is_regular_file(path, code) &&
      std::filesystem::file_size(path, code) > 0)
    refuse("--snapshot", path, "exists and is no snapshot, so it is not replaced",
           "name a new file, or remove this one");
  // Names are compared after links and relative parts are resolved.
  const auto place = [&code](const std::filesystem::path& one) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(one, code), code);
  };
  const std::filesystem::path in = place(path);
  if (!folder.empty() && in.parent_path() == place(folder) &&
      record::RunFolder::writes(in.filename().string()))
    refuse("--snapshot", path, "is the name of a file that the run itself writes",
           "choose another name, or another folder");
}

void check_times(const SimulationOptions& options, const session::Session& session) {
  const double now = session.world().time();
  const std::string end = short_text(session.world().description().recording.duration);
  if (!options.snapshot.empty() &&
      options.snapshot_at > session.world().description().recording.duration)
    refuse("--snapshot-at", short_text(options.snapshot_at), "the run lasts at most " + end + " s",
           "choose an earlier time, or a longer --duration");
  // A resumed state may be later than a shorter duration.
  if (!options.resume.empty() && session.done())
    refuse("--resume", options.resume,
           "the snapshot was taken at " + short_text(now) +
               " s, and nothing is left to run: the duration is " + end +
               " s, or all programs have ended",
           "choose a longer --duration, or an earlier snapshot");
}

std::string changed_kernels_note(const device::KernelSources& kernels) {
  const std::size_t more = kernels.changed.size() - 1;
  return "kernels of '" + kernels.folder + "', not the shipped ones: " + kernels.changed.front() +
         (more > 0 ? " and " + std::to_string(more) + " more differ" : " differs");
}

}  // namespace navvy::run
