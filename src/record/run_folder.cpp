// SPDX-License-Identifier: Apache-2.0
#include "record/run_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/file.h"

namespace navvy::record {
namespace fs = std::filesystem;
namespace {

const std::string kHead = "navvy run folder 1";
const std::string kMoving = kHead + " moving";
/// Names of the files that runs write. A file of such a name that no list contains is of another
/// origin.
const char* const kNames[] = {"scene.sdf",         "run.json",        "summary.json",
                              "telemetry.csv",     "telemetry.npy",   "hashes.csv",
                              "terrain_start.tif", "terrain_end.tif", "failed.snapshot",
                              "summary.reserve",   "replay.jsonl"};

/// Removes the slash at the end that shells complete: ".previous" is appended to the name.
std::string clean(const std::string& directory) {
  const fs::path path = fs::path(directory).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).string();
}

/// Returns true for a name below its own folder. A list may be damaged, so its names are checked.
bool is_plain(const std::string& name) {
  const fs::path path(name);
  if (name.empty() || path.is_absolute()) return false;
  return std::none_of(path.begin(), path.end(), [](const fs::path& part) {
    return part.empty() || part == "." || part == "..";
  });
}

/// Returns true if anything exists at `path`, also a dangling link.
bool is_there(const fs::path& path) {
  std::error_code code;
  return fs::symlink_status(path, code).type() != fs::file_type::not_found;
}

/// Refuses a folder that the user named.
[[noreturn]] void refuse(const std::string& folder, const std::string& rule,
                         const std::string& remedy) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, "--out", folder, rule, remedy});
}

[[noreturn]] void fail(const std::string& action, const std::string& path, int code) {
  throw FileError("cannot " + action + " '" + path + "': " + std::strerror(code));
}

/// Writes all of a text. @throws FileError.
void write_all(int file, const std::string& text, const std::string& path) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::write(file, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("write", path, errno);
    at += static_cast<std::size_t>(n);
  }
}

}  // namespace

bool RunFolder::writes(const std::string& name) {
  return name == kMarker ||
         std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

/// An open list: its lock, its names, and whether its folder was being filled when it was written.
struct RunFolder::Marker {
  int file = -1;
  bool unused = false;  ///< no run has written to it
  std::set<std::string> names;
  bool moving = false;
};

RunFolder::Marker RunFolder::open_marker(const std::string& folder, bool make) const {
  Marker out;
  const std::string path = folder + "/" + kMarker;
  for (;;) {
    out.file = ::open(path.c_str(),
                      O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW | (make ? O_CREAT : 0), 0644);
    if (out.file < 0 && errno == ENOENT && !make) return out;
    if (out.file < 0) fail("write", path, errno);
    // On a file system without locks the run assumes that it is alone.
    if (flock(out.file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(out.file);
      refuse(folder, "another run is writing into this folder",
             "choose another with --out, or wait for its end");
    }
    struct stat found {};
    const bool known = fstat(out.file, &found) == 0;
    // An empty list was made just now, by this run or by another that lost the race for the lock,
    // or it was left by a kill.
    out.unused = known && found.st_size == 0;
    // The previous owner may have removed the file: a lock on a file without a name protects
    // nothing.
    if (!known || found.st_nlink > 0) break;
    ::close(out.file);
  }
  try {
    const std::vector<char> bytes = read_file(path);
    const std::string text(bytes.begin(), bytes.end());
    // A line without its end was cut by a kill.
    std::istringstream lines(text.substr(0, text.rfind('\n') + 1));
    std::string line;
    if (std::getline(lines, line)) {
      out.moving = line == kMoving;
      if (!out.moving && line != kHead)
        refuse(folder,
               "its '" + std::string(kMarker) + "' was not written by this version of Navvy",
               "choose another folder with --out");
    }
    while (std::getline(lines, line))
      if (is_plain(line)) out.names.insert(line);
  } catch (...) {
    if (out.unused) ::unlink(path.c_str());
    ::close(out.file);
    throw;
  }
  return out;
}

namespace {

/// Opens a folder to recognise it later.
int open_place(const std::string& folder) {
  const int place = ::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (place < 0) fail("open", folder, errno);
  return place;
}

/// Returns true if the open file still has a name, and `path` leads to it.
bool is_at(int file, const std::string& path) {
  struct stat own {
  }, named{};
  return fstat(file, &own) == 0 && own.st_nlink > 0 && stat(path.c_str(), &named) == 0 &&
         own.st_dev == named.st_dev && own.st_ino == named.st_ino;
}

}  // namespace

bool RunFolder::intact() const {
  return is_at(place_, directory_) && is_at(lock_, directory_ + "/" + kMarker);
}

std::string RunFolder::move_out() {
  const std::string name = fs::path(directory_).filename().string() + ".saved-XXXXXX";
  std::error_code code;
  for (const fs::path& parent :
       {fs::path(directory_).parent_path(), fs::temp_directory_path(code), fs::path("/tmp")}) {
    std::string made = (parent / name).string();
    if (mkdtemp(made.data()) == nullptr) continue;
    // The lock on the former list ends here, since that list protects nothing any more.
    for (int* file : {&lock_, &place_})
      if (*file >= 0) ::close(std::exchange(*file, -1));
    directory_ = made;
    lock_ = open_marker(directory_, true).file;
    place_ = open_place(directory_);
    listed_.clear();
    write_list(directory_, lock_, listed_, false);
    return directory_;
  }
  throw FileError("cannot create a folder for the results of '" + directory_ +
                  "': " + std::strerror(errno));
}

/// Results must not replace a file of another origin.
void RunFolder::require_free(const Marker& marker, const std::string& folder) const {
  for (const char* name : kNames)
    if (marker.names.count(name) == 0 && is_there(fs::path(folder) / name))
      refuse(folder,
             "it holds a '" + std::string(name) +
                 "' that no run wrote here, or one of an older version",
             "choose another folder with --out, or move the file away");
}

/// A run must not remove what it reads, such as the snapshot that it continues from.
void RunFolder::require_unread(const Marker& marker, const std::string& folder,
                               const std::vector<std::string>& reads) const {
  std::error_code code;
  for (const std::string& read : reads) {
    if (read.empty()) continue;
    for (const std::string& name : marker.names)
      if (fs::equivalent(read, fs::path(folder) / name, code) && !code)
        refuse(directory_,
               "this run reads '" + read + "', which would be removed: the results in '" +
                   directory_ + "' take its place",
               "choose another folder with --out, or move the file away");
  }
}

RunFolder::RunFolder(const std::string& directory, const std::vector<std::string>& reads)
    : directory_(clean(directory)) {
  std::error_code code;
  for (fs::path path = directory_; !path.empty() && !is_there(path); path = path.parent_path())
    made_.push_back(path.string());
  fs::create_directories(directory_, code);
  if (code) {
    const std::string cause = code.message();
    leave();
    throw FileError("cannot create '" + directory_ + "': " + cause);
  }
  // If the folder is a link, the previous results are beside its target.
  const fs::path real = fs::canonical(directory_, code);
  previous_ = (code ? fs::path(directory_) : real).string() + ".previous";
  try {
    Marker marker = open_marker(directory_, true);
    lock_ = marker.file;
    place_ = open_place(directory_);
    unused_ = marker.unused;
    require_free(marker, directory_);
    listed_ = std::move(marker.names);
    // If there is nothing to move, the previous results stay.
    if (listed_.empty() || !is_there(previous_)) return;
    marker = open_marker(previous_, false);
    previous_lock_ = marker.file;
    require_free(marker, previous_);
    if (!marker.moving) require_unread(marker, previous_, reads);
    previous_listed_ = std::move(marker.names);
    previous_moving_ = marker.moving;
  } catch (...) {
    leave();
    throw;
  }
}

RunFolder::~RunFolder() { leave(); }

void RunFolder::leave() {
  close_previous();
  // The marker file is removed while it is locked, so that no other run locks a file that vanishes.
  if (unused_ && !begun_) ::unlink((directory_ + "/" + kMarker).c_str());
  for (int* file : {&lock_, &place_})
    if (*file >= 0) ::close(std::exchange(*file, -1));
  // Only empty folders are removed.
  for (const std::string& path : made_)
    if (begun_ || ::rmdir(path.c_str()) != 0) break;
}

void RunFolder::close_previous() {
  if (previous_lock_ >= 0) ::close(previous_lock_);
  previous_lock_ = -1;
}

/// Rewrites the list in place: a replaced file would lose its lock.
void RunFolder::write_list(const std::string& folder, int file, const std::set<std::string>& names,
                           bool moving) const {
  const std::string path = folder + "/" + kMarker;
  if (ftruncate(file, 0) != 0) fail("write", path, errno);
  std::string text = (moving ? kMoving : kHead) + "\n";
  for (const std::string& name : names) text += name + "\n";
  write_all(file, text, path);
}

namespace {

/// Adds the folders between `folder` and a file in it.
void add_folders_of(const fs::path& file, const fs::path& folder, std::set<fs::path>& folders) {
  for (fs::path path = file.parent_path(); path != folder; path = path.parent_path())
    folders.insert(path);
}

/// Removes empty folders, inner ones first: they sort after those that contain them.
void remove_empty(const std::set<fs::path>& folders) {
  for (auto path = folders.rbegin(); path != folders.rend(); ++path) ::rmdir(path->c_str());
}

/// Removes the listed files, and partial files that a kill may have left.
void remove_listed(const std::string& folder, const std::set<std::string>& names) {
  std::error_code code;
  std::set<fs::path> folders;
  for (const std::string& name : names) {
    const fs::path path = fs::path(folder) / name;
    // A folder of that name is no result.
    if (!fs::is_directory(fs::symlink_status(path, code))) fs::remove(path, code);
    if (code)
      throw FileError("cannot remove the earlier result '" + path.string() +
                      "': " + code.message());
    fs::remove(partial_name(path.string()), code);
    add_folders_of(path, folder, folders);
  }
  remove_empty(folders);
}

}  // namespace

void RunFolder::begin() {
  begun_ = true;
  if (!listed_.empty()) {
    std::error_code code;
    fs::create_directories(previous_, code);
    if (code) throw FileError("cannot create '" + previous_ + "': " + code.message());
    if (previous_lock_ < 0) {
      Marker marker = open_marker(previous_, true);
      previous_lock_ = marker.file;
      require_free(marker, previous_);
    }
    // Files of an interrupted move belong to the previous run, not to the one before it.
    if (!previous_moving_) remove_listed(previous_, previous_listed_);
    write_list(previous_, previous_lock_, listed_, true);
    // Each file is renamed by itself, so that other files in the folder stay.
    std::set<fs::path> folders;
    for (const std::string& name : listed_) {
      const fs::path from = fs::path(directory_) / name, to = fs::path(previous_) / name;
      fs::remove(partial_name(from.string()), code);
      if (!is_there(from)) continue;
      if (is_there(to) && !previous_moving_)
        throw FileError("cannot move '" + from.string() + "' aside: '" + to.string() +
                        "' is there and of no run");
      fs::create_directories(to.parent_path(), code);
      fs::rename(from, to, code);
      if (code)
        throw FileError("cannot move '" + from.string() + "' to '" + to.string() +
                        "': " + code.message());
      add_folders_of(from, directory_, folders);
    }
    remove_empty(folders);
    write_list(previous_, previous_lock_, listed_, false);
    close_previous();
  }
  listed_.clear();
  write_list(directory_, lock_, listed_, false);
}

std::string RunFolder::path(const std::string& name) {
  const std::string path = directory_ + "/" + name;
  if (!is_plain(name)) throw Error("run folder: '" + name + "' is no name of a file in it");
  if (!intact())
    throw FileError("the folder of the results '" + directory_ +
                    "' was removed or replaced while the run wrote to it");
  if (listed_.count(name) > 0) return path;
  if (is_there(path))
    throw FileError("cannot write '" + path + "': it is there and this run did not write it");
  std::error_code code;
  fs::create_directories(fs::path(path).parent_path(), code);
  if (code) throw FileError("cannot create the folder of '" + path + "': " + code.message());
  // Listed first: an unlisted file would count as one of another origin.
  write_all(lock_, name + "\n", directory_ + "/" + kMarker);
  listed_.insert(name);
  return path;
}

}  // namespace navvy::record
