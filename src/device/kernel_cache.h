// SPDX-License-Identifier: Apache-2.0
// Folder with kernels that the OpenCL driver has compiled. Its files are verified before the driver
// loads them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace navvy::device {

/// Folder of compiled kernels with a manifest, a list of its files.
///
/// PoCL maps the machine code in its cache into the process without a check: one file that was
/// truncated by a full disk or a killed process makes every later run end with SIGBUS. Navvy
/// therefore makes the driver use a separate folder and keeps a manifest with sizes and hashes.
/// When the folder is opened, every kernel with a file that differs from the manifest is removed,
/// and the driver compiles it again; `seal` adds newly compiled files to the manifest.
///
/// Several processes may use the same folder; each holds a shared lock on it. Files that are not in
/// the manifest are removed only if no other process uses the folder, as they were then left by a
/// killed process; otherwise another process may just have compiled them.
class KernelCache {
 public:
  /// Creates the folder if necessary, takes the lock and verifies the files, which reads the whole
  /// folder (a few MB).
  /// @throws FileError naming folder and cause if the folder cannot be created, locked or written,
  /// if its disk is nearly full, or if a file in it cannot be read (too many open files, no memory,
  /// a failing disk, no permission); nothing was removed then
  explicit KernelCache(const std::filesystem::path& folder);
  /// Calls `seal` and releases the lock.
  ~KernelCache();
  KernelCache(const KernelCache&) = delete;
  KernelCache& operator=(const KernelCache&) = delete;

  /// Returns the path of the folder.
  const std::filesystem::path& folder() const { return folder_; }
  /// Returns the number of intact files found when the folder was opened.
  std::size_t whole() const { return whole_; }
  /// Returns the number of files that were removed when the folder was opened, because a file of
  /// their kernel was damaged.
  std::size_t removed() const { return removed_; }

  /// Adds all files to the manifest that did not exist when the folder was opened. Files that
  /// another process has listed since are hashed again, as this process may have replaced them.
  /// Never throws: if the manifest cannot be written, the next process compiles the kernels again.
  void seal() noexcept;

  /// Name of the lock file; a folder that contains such a file belongs to Navvy.
  static constexpr const char* kLockName = "navvy.lock";

 private:
  /// Manifest entry of one file.
  struct Entry {
    std::uintmax_t size = 0;  ///< size of the file [bytes]
    std::string hash;         ///< hash of the content, 16 hex digits
  };
  /// Manifest entries, keyed by path relative to the folder.
  using Manifest = std::map<std::string, Entry>;

  /// Returns the manifest in the folder. If it is damaged or missing, the result has fewer entries
  /// or none.
  /// @throws FileError if it is there and cannot be read
  Manifest read_manifest() const;
  /// Replaces the manifest in the folder.
  /// @throws FileError if it cannot be written
  void write_manifest(const Manifest& manifest) const;
  /// Compares the files with the manifest and removes every program with a file that differs.
  /// `alone` is true if no other process uses the folder.
  void check(bool alone);
  /// Removes the compiled programs in the folders `programs`, with all their files, from the cache
  /// folder and from `manifest`.
  void remove_programs(const std::set<std::filesystem::path>& programs, Manifest manifest);
  /// Takes an exclusive lock if no other process uses the folder, otherwise a shared one.
  void lock();

  std::filesystem::path folder_;  ///< path of the folder
  int lock_ = -1;                 ///< file descriptor of the lock file; -1: not open
  bool alone_ = true;             ///< true: no other process used the folder when it was opened
  /// Numbers of intact files and of removed files when the folder was opened.
  std::size_t whole_ = 0, removed_ = 0;
  std::set<std::string> found_;  ///< intact files that existed when the folder was opened
};

/// State of the cache folder of this process.
struct KernelCacheStatus {
  /// Path of the folder that the driver uses; empty if no folder can be written.
  std::string folder;
  /// Reason why `folder` is not the usual folder, or what was wrong in the folder; empty if there
  /// was no problem.
  std::string trouble;
  /// True: the folder was created for this process and is removed when it ends.
  bool temporary = false;
};

/// Opens the cache folder of this process and sets POCL_CACHE_DIR to it for the driver. Only the
/// first call does so, which must precede the first OpenCL call; all calls return the state. The
/// folder is `navvy/kernels` in the first of POCL_CACHE_DIR, XDG_CACHE_HOME and ~/.cache that is
/// set, or a temporary folder if that one is not writable. Must not run while another thread
/// changes the environment.
const KernelCacheStatus& prepare_kernel_cache();
/// Adds the kernels compiled so far to the manifest: calls KernelCache::seal for the folder of this
/// process.
void seal_kernel_cache() noexcept;
/// Removes the folder of this process if it is temporary. Call it before the process ends without
/// running destructors.
void abandon_kernel_cache() noexcept;

}  // namespace navvy::device
