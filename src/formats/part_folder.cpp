// SPDX-License-Identifier: Apache-2.0
// A rename cannot replace a folder that holds files, so the two folders are exchanged.
#include "formats/part_folder.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/error.h"
#include "core/file.h"

namespace navvy::formats {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& cause) {
  throw FileError("cannot write the folder '" + path + "': " + cause);
}

/// Returns the absolute path without dots and without a slash at its end, with links followed.
fs::path target_of(const std::string& path) {
  const auto clean = [](const fs::path& p) {
    const fs::path out = fs::absolute(p).lexically_normal();
    return out.has_filename() ? out : out.parent_path();
  };
  return clean(followed(clean(path).string()));
}

/// Returns the folder `target`.part/, in which the new folder is written.
fs::path part_of(const fs::path& target) { return target.string() + ".part"; }

/// Checks that everything in `folder` is one of `files`, a partial file that a kill left, or a
/// folder above one.
void require_ours(const std::string& path, const fs::path& folder,
                  const std::vector<std::string>& files) {
  std::error_code code;
  const fs::file_status status = fs::symlink_status(folder, code);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) fail(folder.string(), "it is there and no folder (name another)");
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code)) {
    const std::string name = at->path().lexically_relative(folder).string();
    const fs::file_status found = at->symlink_status(code);
    const bool ours = std::any_of(files.begin(), files.end(), [&](const std::string& file) {
      if (fs::is_directory(found)) return file.rfind(name + "/", 0) == 0;
      return fs::is_regular_file(found) && (name == file || name == file + ".part");
    });
    if (!ours)
      throw InputError(Fault{Fault::Severity::kError, path, 0, "map", name,
                             "in the folder '" + folder.string() + "' is not a file of this format",
                             "name a new folder, or move the other files away"});
  }
  if (code) fail(path, code.message());
}

std::vector<std::string> within(const std::string& folder, const std::vector<std::string>& files) {
  std::vector<std::string> out;
  out.reserve(files.size());
  for (const std::string& file : files) out.push_back(folder + "/" + file);
  return out;
}

}  // namespace

std::string folder_name(const std::string& path) { return target_of(path).filename().string(); }

// Both places are checked before anything is written.
void require_folder(const std::string& path, const std::vector<std::string>& files) {
  const fs::path target = target_of(path);
  if (!target.has_filename()) fail(path, "it has no name");
  require_ours(path, target, files);
  // The partial folder may hold files that a kill left, or that another process writes now.
  require_ours(path, part_of(target), within(target.filename().string(), files));
}

PartFolder::PartFolder(const std::string& path, std::vector<std::string> files)
    : path_(path),
      files_(std::move(files)),
      target_(target_of(path)),
      part_(part_of(target_)),
      place_(part_ / target_.filename()) {
  require_folder(path_, files_);
  std::error_code code;
  fs::remove_all(part_, code);
  if (!code) fs::create_directories(place_, code);
  if (code) fail(path_, code.message());
}

// Errors are ignored here, because destructors must not throw.
PartFolder::~PartFolder() {
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

// Exchanging is atomic: at every moment one complete folder has the name.
void PartFolder::commit() {
  // Another process may have added files while this one was writing.
  require_ours(path_, target_, files_);
  std::error_code code;
  if (!fs::exists(target_, code)) {
    fs::rename(place_, target_, code);
  } else if (::renameat2(AT_FDCWD, place_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) !=
             0) {
    // Some file systems cannot exchange folders. For a moment neither is in place then, and a kill
    // leaves both in the partial folder.
    if (errno != EINVAL && errno != ENOSYS) fail(path_, std::strerror(errno));
    const fs::path old = part_ / (target_.filename().string() + ".old");
    fs::rename(target_, old, code);
    if (!code) {
      fs::rename(place_, target_, code);
      std::error_code ignored;
      if (code) fs::rename(old, target_, ignored);
    }
  }
  if (code) fail(path_, code.message());
  fs::remove_all(part_, code);
}

}  // namespace navvy::formats
