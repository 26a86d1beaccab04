// SPDX-License-Identifier: Apache-2.0
// A rename cannot take the place of a folder that holds something, so the two are exchanged.
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

/// Absolute, without dots and a slash at its end; behind links.
fs::path target_of(const std::string& path) {
  const auto clean = [](const fs::path& p) {
    const fs::path out = fs::absolute(p).lexically_normal();
    return out.has_filename() ? out : out.parent_path();
  };
  return clean(followed(clean(path).string()));
}

/// Where it is written: `target`.part/, which holds one folder.
fs::path part_of(const fs::path& target) { return target.string() + ".part"; }

/// All that lies in `folder` must be one of `files`, what a kill left of its writing, or a folder
/// on the way to one.
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
      throw InputError(Fault{
          Fault::Severity::kError, path, 0, "map", name,
          "lies in the folder '" + folder.string() + "' and is no file that this format writes",
          "name a new folder, or move what lies there away"});
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

void require_folder(const std::string& path, const std::vector<std::string>& files) {
  const fs::path target = target_of(path);
  if (!target.has_filename()) fail(path, "it has no name");
  require_ours(path, target, files);
  // What a kill left, or another process writes now.
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

PartFolder::~PartFolder() {
  std::error_code ignored;
  fs::remove_all(part_, ignored);
}

void PartFolder::commit() {
  // Somebody may have put something there while it was written.
  require_ours(path_, target_, files_);
  std::error_code code;
  if (!fs::exists(target_, code)) {
    fs::rename(place_, target_, code);
  } else if (::renameat2(AT_FDCWD, place_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) !=
             0) {
    // Some file systems exchange nothing: for a moment neither is there, and a kill then leaves
    // both in the part.
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
