// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_cache.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
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
/// Held while the manifest is read and written anew; begins as its name does, so that no list
/// speaks of it.
const char* const kManifestLockName = "navvy.manifest.lock";
/// The manifest's first line; another one means another layout, and everything is compiled anew.
constexpr std::string_view kManifestHead = "navvy kernel cache 1";
/// All our kernels of one version take a few MB compiled. Above this the folder holds many
/// versions: it is emptied.
constexpr std::uintmax_t kMostBytes = std::uintmax_t{512} << 20;
/// With less room on the disk the driver would leave half-written files behind.
constexpr std::uintmax_t kLeastCapacity = std::uintmax_t{16} << 20;

[[noreturn]] void fail(const fs::path& folder, const std::string& cause) {
  throw FileError("kernel cache '" + folder.string() + "': " + cause);
}

std::string hash_of(const fs::path& file) {
  const std::vector<char> bytes = read_file(file.string());
  StateHash hash;
  hash.bytes(bytes.data(), bytes.size());
  return hash.hex();
}

/// What the manifest speaks of: the driver's files, without its time stamps, which it rewrites at
/// every use. Listed, they would make every program look damaged.
bool is_listed(const fs::path& relative) {
  const std::string name = relative.filename().string();
  return name != KernelCache::kLockName && name.rfind(kManifestName, 0) != 0 &&
         name != "last_accessed";
}

/// What the driver writes to before it gives a file its name.
bool is_temporary(const fs::path& relative) {
  return relative.filename().string().rfind("tempfile_", 0) == 0;
}

/// Keeps neighbours from writing the manifest between our reading and our writing; one that holds
/// it is waited for, a few milliseconds. Where its file cannot be made it keeps nobody: a list that
/// lacks files only makes the next process compile again.
class ManifestLock {
 public:
  explicit ManifestLock(const fs::path& folder)
      : file_(::open((folder / kManifestLockName).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  ~ManifestLock() {
    if (file_ >= 0) ::close(file_);
  }
  ManifestLock(const ManifestLock&) = delete;
  ManifestLock& operator=(const ManifestLock&) = delete;

 private:
  int file_;
};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  // A folder that cannot be listed to its end gives what was found: check() then misses files and
  // takes their programs as spoiled, which is safe.
  std::error_code error;
  for (fs::recursive_directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error)) {
    // A neighbour may rename its temporary file between the listing and the look at it
    std::error_code gone;
    if (it->is_regular_file(gone) && !gone) files.push_back(it->path().lexically_relative(folder));
  }
  return files;
}

/// The part of the folder that is one compiled program: a changed file spoils the whole of it, as
/// the driver takes the presence of some of its files as proof of the others. PoCL puts a program
/// two folders deep, by the digits of its hash.
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
  // Made with all its parents, as ~/.cache may not exist on a fresh account.
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) fail(folder_, "the folder cannot be made: " + error.message());
  // The driver does not tell when it cannot write: it leaves files that are cut short, which is
  // what this class is about.
  struct statvfs disk {};
  if (statvfs(folder_.c_str(), &disk) == 0 &&
      std::uintmax_t{disk.f_bavail} * disk.f_frsize < kLeastCapacity)
    fail(folder_, "its disk is full (less than 16 MiB left)");
  lock();
  try {
    check(alone_);
    // Shared from now on. Between the two kinds of lock another process may check the folder too,
    // which changes nothing.
    flock(lock_, LOCK_SH);
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

// The lock goes with its file descriptor, so a process that is killed leaves none behind.
KernelCache::~KernelCache() {
  try {
    seal();
  } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
    // Memory ended: what is not listed is compiled anew by the next process, and this one ends as
    // it would have.
  }
  ::close(lock_);
}

void KernelCache::lock() {
  const std::string path = (folder_ / kLockName).string();
  lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0) fail(folder_, std::string("it cannot be written: ") + std::strerror(errno));
  // Exclusive first: only who is alone may remove files that nobody listed.
  alone_ = flock(lock_, LOCK_EX | LOCK_NB) == 0;
  // A neighbour checks for milliseconds; a folder whose file system knows no locks is used as if
  // alone.
  if (!alone_ && errno != EWOULDBLOCK) alone_ = true;
  if (!alone_) flock(lock_, LOCK_SH);
}

// A manifest that is missing, of another layout or damaged lists less than there is, and what is
// not listed is compiled again: reading it needs no error of its own.
KernelCache::Manifest KernelCache::read_manifest() const {
  Manifest out;
  std::string text;
  try {
    const std::vector<char> bytes = read_file((folder_ / kManifestName).string());
    text.assign(bytes.begin(), bytes.end());
  } catch (const FileError&) {
    return out;  // the first run here
  }
  std::istringstream lines(text);
  std::string line;
  if (!std::getline(lines, line) || line != kManifestHead) return out;
  while (std::getline(lines, line)) {
    // "<size> <hash> <path>"; a line that is cut short lists nothing, so that its file is compiled
    // again.
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

// Programs go as a whole: the driver takes the presence of some files as proof of the others.
void KernelCache::remove_programs(const std::set<fs::path>& programs, Manifest manifest) {
  if (programs.empty()) return;
  for (const fs::path& program : programs) {
    std::error_code error;
    fs::remove_all(folder_ / program, error);
    // What cannot be removed would be loaded: such a folder is no cache.
    if (error) fail(folder_, "a file in it is damaged and cannot be removed: " + error.message());
  }
  // Out of the list at once: a neighbour would find the files gone, and remove what this process
  // compiles in their place.
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
  // Three things are gathered: the programs of which one file is wrong, the files that were seen,
  // and the size of all.
  std::uintmax_t bytes = 0;
  std::set<fs::path> bad;
  std::set<std::string> seen;
  for (const fs::path& file : files) {
    if (!is_listed(file)) continue;
    std::error_code error;
    if (is_temporary(file)) {
      // PoCL leaves one of these behind in every run: no damage. A neighbour's may be about to get
      // its name.
      if (alone) fs::remove(folder_ / file, error);
      continue;
    }
    const std::uintmax_t size = fs::file_size(folder_ / file, error);
    const auto entry = manifest.find(file.generic_string());
    seen.insert(file.generic_string());
    bytes += error ? 0 : size;
    bool good = !error;
    if (entry == manifest.end()) {
      // Nobody has vouched for the file. Alone, it is left over from a process that was killed and
      // may be cut short; beside others, a neighbour may have just finished it.
      good = !alone;
    } else if (good) {
      try {
        good = size == entry->second.size && hash_of(folder_ / file) == entry->second.hash;
      } catch (const FileError&) {
        good = false;  // there, but not to be read
      }
      // Two neighbours that compile one program both name their file so: the later one is not
      // listed yet.
      std::error_code gone;
      good = good || (!alone && fs::last_write_time(folder_ / file, gone) > listed && !gone);
    }
    if (!good) bad.insert(program_of(file));
  }
  // A file that is gone spoils its program as one that changed.
  for (const auto& [path, entry] : manifest)
    if (seen.count(path) == 0) bad.insert(program_of(path));
  for (const fs::path& file : files) {
    if (!is_listed(file) || is_temporary(file)) continue;
    const bool remove = bad.count(program_of(file)) > 0 || (alone && bytes > kMostBytes);
    ++(remove ? removed_ : whole_);
    if (!remove) found_.insert(file.generic_string());
  }
  remove_programs(bad, manifest);
  // Emptied, not thinned out: old versions of Navvy have left the most of it, and compiling anew
  // takes seconds.
  if (alone && bytes > kMostBytes) {
    std::error_code error;
    for (fs::directory_iterator it(folder_, error), end; !error && it != end; it.increment(error)) {
      std::error_code kept;  // what cannot be removed was found whole above
      if (it->path().filename() != kLockName) fs::remove_all(it->path(), kept);
    }
  }
}

void KernelCache::seal() noexcept {
  try {
    const ManifestLock held(folder_);
    // Read again, as neighbours may have listed files of theirs since this process began.
    const Manifest old = read_manifest();
    Manifest now;
    for (const fs::path& file : files_in(folder_)) {
      // PoCL writes to a file of this name first and renames it; half of one must not be vouched
      // for.
      if (!is_listed(file) || is_temporary(file)) continue;
      const std::string name = file.generic_string();
      const auto entry = old.find(name);
      // What was listed when this process began stays as listed: a file that changed since is found
      // out by the next check. What a neighbour has listed since is looked at again: where both
      // compiled one program, this process's file has taken the place of the other's, and the
      // driver does not write the same bytes twice.
      if (entry != old.end() && found_.count(name) > 0) {
        now[name] = entry->second;
        continue;
      }
      try {
        now[name] = Entry{fs::file_size(folder_ / file), hash_of(folder_ / file)};
      } catch (const FileError&) {             // NOLINT(bugprone-empty-catch)
      } catch (const fs::filesystem_error&) {  // NOLINT(bugprone-empty-catch)
        // A neighbour has removed it meanwhile.
      }
    }
    write_manifest(now);
  } catch (const std::exception&) {
    // The next process finds files that nobody listed and compiles them again.
  }
}

namespace {

/// Of a temporary folder, for whoever cannot wait for a destructor.
std::atomic<const char*> temporary_folder{nullptr};

/// The process's folder, and how it came about. The status is filled by the constructor and does
/// not change afterwards, so references to it may be kept.
struct ProcessCache {
  KernelCacheStatus status;
  std::unique_ptr<KernelCache> cache;

  ProcessCache();
  ~ProcessCache();

 private:
  bool open(const fs::path& folder);
  void open_temporary();
};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The usual folder; empty when the environment names no place for caches.
fs::path usual_folder() {
  const std::string given = environment("POCL_CACHE_DIR");
  // A child inherits what its parent has set: one of our folders is taken as it is.
  std::error_code closed;  // a folder that may not be looked into is none of ours
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
    // A folder that cannot be used is no reason to stop: the next one is tried, and all reasons are
    // told together.
  } catch (const std::exception& error) {
    status.trouble += (status.trouble.empty() ? "" : "; ") + std::string(error.what());
    return false;
  }
  status.folder = folder.string();
  return true;
}

void ProcessCache::open_temporary() {
  // /dev/shm is the last resort: what lies there takes memory from the run.
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

ProcessCache::ProcessCache() {
  const fs::path folder = usual_folder();
  if (folder.empty()) status.trouble = "neither POCL_CACHE_DIR, XDG_CACHE_HOME nor HOME is set";
  if (folder.empty() || !open(folder)) open_temporary();
  if (status.folder.empty()) {
    log_warning("no folder can be written for compiled kernels (" + status.trouble +
                "): set POCL_CACHE_DIR to one that can");
    return;
  }
  if (status.temporary) temporary_folder = status.folder.c_str();
  // Loud where the user pays for it at every run, quiet where it happened once.
  if (status.temporary)
    log_warning(status.trouble + ": kernels are compiled anew for this run, in " + status.folder);
  if (!status.temporary && cache->removed() > 0) {
    status.trouble = std::to_string(cache->removed()) + " files of compiled kernels in " +
                     status.folder +
                     " were damaged or left over from a killed run: they are compiled again";
    log_info(status.trouble);
  }
  // From here on the driver uses this folder, and so do programs that this one starts.
  ::setenv("POCL_CACHE_DIR", status.folder.c_str(), 1);
}

ProcessCache::~ProcessCache() {
  // The cache closes its lock before the folder of a temporary one is removed.
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
  // Made by the first call and gone after every Device: devices call prepare_kernel_cache() in
  // their construction, and what is constructed later is destroyed earlier.
  static ProcessCache cache;
  return cache;
}

}  // namespace

const KernelCacheStatus& prepare_kernel_cache() { return process_cache().status; }

void seal_kernel_cache() noexcept {
  if (process_cache().cache) process_cache().cache->seal();
}

void abandon_kernel_cache() noexcept {
  const char* folder = temporary_folder;
  std::error_code ignored;
  if (folder != nullptr) fs::remove_all(folder, ignored);
}

}  // namespace navvy::device
