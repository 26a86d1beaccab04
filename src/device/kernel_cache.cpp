// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "core/log.h"

namespace navvy::device {
namespace {

namespace fs = std::filesystem;

const char* const kManifestName = "navvy.manifest";
/// Locked while the manifest is read and rewritten. Its name begins like the manifest's, so that it
/// is not listed.
const char* const kManifestLockName = "navvy.manifest.lock";
/// First line of a manifest. With any other, the layout is unknown and everything is compiled
/// again.
constexpr std::string_view kManifestHead = "navvy kernel cache 1";
/// Size above which the folder is emptied. The kernels of one version take a few MB, so it holds
/// many old versions then.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{512} << 20;
/// Free space on the disk below which the driver would leave half-written files.
constexpr std::uintmax_t kLeastCapacity = std::uintmax_t{16} << 20;

[[noreturn]] void fail(const fs::path& folder, const std::string& cause) {
  throw FileError("kernel cache '" + folder.string() + "': " + cause);
}

/// Stops the use of a folder whose state is unknown: too many open files, no memory, a failing disk
/// or no permission say nothing about the files in it, which may be intact and in use.
[[noreturn]] void fail_unread(const fs::path& folder, const fs::path& file, int code) {
  fail(folder, "'" + file.string() + "' in it cannot be read: " + std::strerror(code));
}

/// Returns true for errors that say that there is no such file.
bool is_missing(int code) { return code == ENOENT || code == ENOTDIR; }

/// Returns the content of a file of the folder; nothing if there is no such file.
/// @throws FileError for any other reason not to read it
std::optional<std::string> content_of(const fs::path& folder, const fs::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(
      std::fopen((folder / file).c_str(), "rbe"), std::fclose);
  if (!in && is_missing(errno)) return {};
  if (!in) fail_unread(folder, file, errno);
  std::string out;
  char buffer[65536];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, in.get()))
    out.append(buffer, n);
  if (std::ferror(in.get()) != 0) fail_unread(folder, file, errno);
  return out;
}

/// Returns the hash of a file's content; nothing if there is no such file.
std::optional<std::string> hash_of(const fs::path& folder, const fs::path& file) {
  const std::optional<std::string> content = content_of(folder, file);
  if (!content) return {};
  StateHash hash;
  hash.bytes(content->data(), content->size());
  return hash.hex();
}

/// Returns the size of a file [bytes]; nothing if there is no such file.
std::optional<std::uintmax_t> size_of(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(folder / file, error);
  if (error && !is_missing(error.value())) fail_unread(folder, file, error.value());
  return error ? std::optional<std::uintmax_t>() : size;
}

/// Returns true for files that the manifest lists: the driver's files without its time stamps,
/// which it rewrites at every use and which would make every program look damaged.
bool is_listed(const fs::path& relative) {
  const std::string name = relative.filename().string();
  return name != KernelCache::kLockName && name.rfind(kManifestName, 0) != 0 &&
         name != "last_accessed";
}

/// Returns true for files that the driver writes before it renames them.
bool is_temporary(const fs::path& relative) {
  return relative.filename().string().rfind("tempfile_", 0) == 0;
}

/// Prevents other processes from writing the manifest between reading and writing it; waits for
/// them, a few milliseconds.
class ManifestLock {
 public:
  explicit ManifestLock(const fs::path& folder)
      : file_(::open((folder / kManifestLockName).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ < 0) fail_unread(folder, kManifestLockName, errno);
    flock(file_, LOCK_EX);
  }
  ~ManifestLock() { ::close(file_); }
  ManifestLock(const ManifestLock&) = delete;
  ManifestLock& operator=(const ManifestLock&) = delete;

 private:
  int file_;
};

/// Lists all regular files of a folder, relative to it. Returns false if another process has
/// removed a folder in it meanwhile.
bool list_files(const fs::path& folder, std::vector<fs::path>& files) {
  files.clear();
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    // Another process may rename its temporary file between listing and query.
    std::error_code gone;
    if (it->is_regular_file(gone) && !gone) files.push_back(it->path().lexically_relative(folder));
    if (gone && !is_missing(gone.value())) fail_unread(folder, it->path(), gone.value());
  }
  if (error && !is_missing(error.value())) fail_unread(folder, ".", error.value());
  return !error;
}

/// Returns all regular files of a folder, relative to it.
/// @throws FileError if it cannot be listed completely: files that are not seen are not missing
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (int times = 0; times < 10; ++times)
    if (list_files(folder, files)) return files;
  fail_unread(folder, ".", EAGAIN);
}

/// Returns the part of the path that identifies one compiled program. The driver takes the presence
/// of some files of a program as proof of the others, so one changed file invalidates all of them.
/// PoCL stores a program two folders deep, by the digits of its hash.
fs::path program_of(const fs::path& relative) {
  fs::path out;
  int depth = 0;
  for (const fs::path& part : relative) {
    if (depth++ == 2) break;
    out /= part;
  }
  return out;
}

}  // namespace

KernelCache::KernelCache(const fs::path& folder) : folder_(folder) {
  // With all parents, as ~/.cache may not exist on a new account.
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) fail(folder_, "the folder cannot be created: " + error.message());
  // The driver does not report that it cannot write: it leaves truncated files, which this class
  // protects against.
  struct statvfs disk {};
  if (statvfs(folder_.c_str(), &disk) == 0 &&
      std::uintmax_t{disk.f_bavail} * disk.f_frsize < kLeastCapacity)
    fail(folder_, "its disk is full (less than 16 MiB left)");
  lock();
  try {
    check(alone_);
    // Shared from now on. Another process may check the folder between the two locks, which changes
    // nothing.
    flock(lock_, LOCK_SH);
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

// The lock is bound to its file descriptor, so a killed process leaves none behind.
KernelCache::~KernelCache() {
  try {
    seal();
  } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
    // Out of memory: what is not listed is compiled again by the next process.
  }
  ::close(lock_);
}

void KernelCache::lock() {
  const std::string path = (folder_ / kLockName).string();
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) fail(folder_, std::string("it cannot be written: ") + std::strerror(errno));
  // Exclusive first: only a process that is alone may remove files that are not listed.
  alone_ = flock(lock_, LOCK_EX | LOCK_NB) == 0;
  // Another process checks for milliseconds. If the file system has no locks, the folder is used as
  // if alone.
  if (!alone_ && errno != EWOULDBLOCK) alone_ = true;
  if (!alone_) flock(lock_, LOCK_SH);
}

// A manifest that is missing, damaged or of another layout lists fewer files, and what is not
// listed is compiled again. One that cannot be read lists an unknown number of them.
KernelCache::Manifest KernelCache::read_manifest() const {
  Manifest out;
  std::istringstream lines(content_of(folder_, kManifestName).value_or(""));
  std::string line;
  if (!std::getline(lines, line) || line != kManifestHead) return out;
  while (std::getline(lines, line)) {
    // "<size> <hash> <path>"; a truncated line lists nothing, so its file is compiled again.
    std::istringstream words(line);
    Entry entry;
    std::string path;
    if (words >> entry.size >> entry.hash && words.get() == ' ' && std::getline(words, path))
      out[path] = entry;
  }
  return out;
}

void KernelCache::write_manifest(const Manifest& manifest) const {
  std::string text = std::string(kManifestHead) + "\n";
  for (const auto& [name, entry] : manifest)
    text += std::to_string(entry.size) + " " + entry.hash + " " + name + "\n";
  write_file_atomically((folder_ / kManifestName).string(), text);
}

// Removes whole programs: the driver takes the presence of some files as proof of the others.
void KernelCache::remove_programs(const std::set<fs::path>& programs, Manifest manifest) {
  if (programs.empty()) return;
  for (const fs::path& program : programs) {
    std::error_code error;
    fs::remove_all(folder_ / program, error);
    // A damaged file that stays would be loaded, so such a folder cannot be a cache.
    if (error) fail(folder_, "a file in it is damaged and cannot be removed: " + error.message());
  }
  // Removed from the list at once: otherwise another process would find the files missing and
  // remove what this process compiles in their place.
  std::erase_if(manifest,
                [&](const auto& listed) { return programs.count(program_of(listed.first)) > 0; });
  write_manifest(manifest);
}

void KernelCache::check(bool alone) {
  const ManifestLock held(folder_);
  const Manifest manifest = read_manifest();
  std::error_code unlisted;
  const fs::file_time_type listed = fs::last_write_time(folder_ / kManifestName, unlisted);
  const std::vector<fs::path> files = files_in(folder_);
  // Collects the programs with a damaged file, the files that exist, and their total size.
  std::uintmax_t bytes = 0;
  std::set<fs::path> bad;
  std::set<std::string> seen;
  for (const fs::path& file : files) {
    if (!is_listed(file) || is_temporary(file)) continue;
    const std::optional<std::uintmax_t> size = size_of(folder_, file);
    const auto entry = manifest.find(file.generic_string());
    seen.insert(file.generic_string());
    bytes += size.value_or(0);
    bool good = size.has_value();
    if (entry == manifest.end()) {
      // The file is not listed. If this process is alone, a killed process left it, maybe
      // truncated; otherwise another process may just have finished it.
      good = !alone;
    } else if (good) {
      good = size == entry->second.size && hash_of(folder_, file) == entry->second.hash;
      // If two processes compile one program, both use this file name, and the later file is not
      // listed yet.
      std::error_code gone;
      good = good || (!alone && fs::last_write_time(folder_ / file, gone) > listed && !gone);
    }
    if (!good) bad.insert(program_of(file));
  }
  // A missing file invalidates its program like a changed one.
  for (const auto& [path, entry] : manifest)
    if (seen.count(path) == 0) bad.insert(program_of(path));
  // Nothing was removed up to here, so a file that cannot be read leaves the folder as it was.
  for (const fs::path& file : files) {
    if (!is_listed(file)) continue;
    if (is_temporary(file)) {
      // PoCL leaves one temporary file behind in every run, which is no damage. Another process may
      // be about to rename its own.
      std::error_code error;
      if (alone) fs::remove(folder_ / file, error);
      continue;
    }
    const bool remove = bad.count(program_of(file)) > 0 || (alone && bytes > kMostBytes);
    ++(remove ? removed_ : whole_);
    if (!remove) found_.insert(file.generic_string());
  }
  remove_programs(bad, manifest);
  // Emptied rather than thinned out: most of it is of old versions, and compiling again takes
  // seconds.
  if (alone && bytes > kMostBytes) {
    std::error_code error;
    for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
      // Files that cannot be removed were found intact above.
      std::error_code ignored;
      if (it->path().filename() != kLockName) fs::remove_all(it->path(), ignored);
    }
  }
}

void KernelCache::seal() noexcept {
  try {
    const ManifestLock held(folder_);
    // Read again, as other processes may have listed files meanwhile.
    const Manifest old = read_manifest();
    Manifest now;
    for (const fs::path& file : files_in(folder_)) {
      // PoCL writes to a file of this name first and renames it; an incomplete file must not be
      // listed.
      if (!is_listed(file) || is_temporary(file)) continue;
      const std::string name = file.generic_string();
      const auto entry = old.find(name);
      // Files that were listed when this process began keep their entry, so the next check finds
      // those that changed since. Files that another process has listed since are read again: if
      // both compiled one program, this process may have replaced the file, and the driver does not
      // write the same bytes twice.
      if (entry != old.end() && found_.count(name) > 0) {
        now[name] = entry->second;
        continue;
      }
      // Without a size or hash, another process has removed the file meanwhile.
      const std::optional<std::uintmax_t> size = size_of(folder_, file);
      const std::optional<std::string> hash = hash_of(folder_, file);
      if (size && hash) now[name] = Entry{*size, *hash};
    }
    write_manifest(now);
  } catch (const std::exception&) {
    // The list stays as it was: the next process compiles again what this one has compiled.
  }
}

namespace {

/// Path of a temporary folder, for a process that ends without destructors.
std::atomic<const char*> temporary_folder{nullptr};

/// Cache folder of this process. The constructor fills the status, which does not change
/// afterwards, so references to it stay valid.
struct ProcessCache {
  KernelCacheStatus status;
  std::unique_ptr<KernelCache> cache;

  ProcessCache();
  ~ProcessCache();

 private:
  bool open(const fs::path& folder);
  void open_temporary();
};

/// Returns an environment variable, or "" if it is not set.
std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Returns the usual folder, or an empty path if the environment names no place for caches.
fs::path usual_folder() {
  const std::string given = environment("POCL_CACHE_DIR");
  // A child process inherits the parent's setting, so a folder that holds our lock file is used as
  // it is.
  // A folder without access is not one of ours.
  std::error_code closed;
  if (!given.empty() && fs::exists(fs::path(given) / KernelCache::kLockName, closed)) return given;
  if (!given.empty()) return fs::path(given) / "navvy" / "kernels";
  if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty())
    return fs::path(xdg) / "navvy" / "kernels";
  if (const std::string home = environment("HOME"); !home.empty())
    return fs::path(home) / ".cache/navvy/kernels";
  return {};
}

bool ProcessCache::open(const fs::path& folder) {
  try {
    cache = std::make_unique<KernelCache>(folder);
    // An unusable folder is no reason to stop: the next one is tried, and all reasons are reported
    // together.
  } catch (const std::exception& error) {
    status.trouble += (status.trouble.empty() ? "" : "; ") + std::string(error.what());
    return false;
  }
  status.folder = folder.string();
  return true;
}

void ProcessCache::open_temporary() {
  // /dev/shm is the last choice, as files there take memory from the run.
  std::vector<std::string> places = {environment("TMPDIR"), "/tmp", "/var/tmp", "/dev/shm"};
  for (const std::string& place : places) {
    if (place.empty()) continue;
    std::string name = place + "/navvy-kernels-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) {
      status.trouble += "; " + place + ": " + std::strerror(errno);
      continue;
    }
    status.temporary = true;
    if (open(name)) return;
    std::error_code ignored;
    fs::remove_all(name, ignored);
    status.temporary = false;
  }
}

/// PoCL links each kernel with the program `ld`, which it looks for in PATH, and aborts without it.
/// The usual folders are appended where none of PATH has it.
void complete_path() {
  const std::string path = environment("PATH");
  std::istringstream folders(path);
  std::error_code none;
  for (std::string folder; std::getline(folders, folder, ':');)
    if (!folder.empty() && fs::exists(folder + "/ld", none)) return;
  for (const char* folder : {"/usr/bin", "/usr/local/bin", "/bin"})
    if (fs::exists(std::string(folder) + "/ld", none)) {
      ::setenv("PATH", (path.empty() ? folder : path + ":" + folder).c_str(), 1);
      return;
    }
}

ProcessCache::ProcessCache() {
  complete_path();
  const fs::path folder = usual_folder();
  if (folder.empty()) status.trouble = "neither POCL_CACHE_DIR, XDG_CACHE_HOME nor HOME is set";
  if (folder.empty() || !open(folder)) open_temporary();
  if (status.folder.empty()) {
    log_warning("no folder can be written for compiled kernels (" + status.trouble +
                "); set POCL_CACHE_DIR to a folder that can");
    return;
  }
  if (status.temporary) temporary_folder = status.folder.c_str();
  // A warning if every run pays for it, otherwise an information.
  if (status.temporary)
    log_warning(status.trouble + ": kernels are compiled again for this run, in " + status.folder);
  if (!status.temporary && cache->removed() > 0) {
    status.trouble = std::to_string(cache->removed()) + " files of compiled kernels in " +
                     status.folder +
                     " were damaged or left over from a killed run: they are compiled again";
    log_info(status.trouble);
  }
  // The driver, and programs that this one starts, use this folder.
  ::setenv("POCL_CACHE_DIR", status.folder.c_str(), 1);
}

ProcessCache::~ProcessCache() {
  // The cache closes its lock before a temporary folder is removed.
  cache.reset();
  temporary_folder = nullptr;
  if (!status.temporary) return;
  try {
    std::error_code ignored;
    fs::remove_all(status.folder, ignored);
  } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
    // The folder stays in /tmp.
  }
}

ProcessCache& process_cache() {
  // Created by the first call and destroyed after every Device: devices call prepare_kernel_cache()
  // in their construction, and static objects are destroyed in reverse order.
  static ProcessCache cache;
  return cache;
}

}  // namespace

const KernelCacheStatus& prepare_kernel_cache() { return process_cache().status; }

void seal_kernel_cache() noexcept {
  // Devices of several threads may end at the same time.
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> alone(one_at_a_time);
  if (process_cache().cache) process_cache().cache->seal();
}

void abandon_kernel_cache() noexcept {
  const char* folder = temporary_folder;
  std::error_code ignored;
  if (folder != nullptr) fs::remove_all(folder, ignored);
}

}  // namespace navvy::device
