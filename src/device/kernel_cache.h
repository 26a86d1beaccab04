// SPDX-License-Identifier: Apache-2.0
// Folder of kernels compiled by the OpenCL driver, verified before the driver loads from it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace navvy::device {

/// Folder of compiled kernels with a manifest of its files.
///
/// PoCL maps the machine code in its cache into the process unchecked: a single file that a full
/// disk or a kill cut short ends every later run with SIGBUS. Navvy therefore gives the driver a
/// folder of its own and keeps a list of its files with sizes and hashes. Opening the folder
/// removes every kernel with a file that differs from the list, and the driver compiles it again;
/// `seal` lists newly compiled files.
///
/// Several processes may use one folder; each holds a shared lock on it. Files that are not listed
/// are removed only if no other process uses the folder, as they are then leftovers of a killed
/// process; otherwise another process may just have compiled them.
class KernelCache {
 public:
  /// Creates the folder if needed, takes the lock and verifies the files, which reads the whole
  /// folder (a few MB).
  /// @throws FileError naming folder and cause if it cannot be created, locked or written, or if
  /// its disk is nearly full.
  explicit KernelCache(const std::filesystem::path& folder);
  /// Calls `seal` and releases the lock.
  ~KernelCache();
  KernelCache(const KernelCache&) = delete;
  KernelCache& operator=(const KernelCache&) = delete;

  /// Returns the folder.
  const std::filesystem::path& folder() const { return folder_; }
  /// Returns the number of intact files found on opening.
  std::size_t whole() const { return whole_; }
  /// Returns the number of files that were removed on opening because their kernel was damaged.
  std::size_t removed() const { return removed_; }

  /// Adds the files that are new since the folder was opened to the manifest, also those that
  /// another process has listed, since this process may have replaced them. Never throws: without
  /// the list, the next process compiles again.
  void seal() noexcept;

  /// Name of the lock file; a folder that holds it belongs to Navvy.
  static constexpr const char* kLockName = "navvy.lock";

 private:
  struct Entry {
    std::uintmax_t size = 0;
    /// 16 hex digits.
    std::string hash;
  };
  /// Files by path relative to the folder.
  using Manifest = std::map<std::string, Entry>;

  /// Reads the manifest; a damaged or missing one lists fewer files or none.
  Manifest read_manifest() const;
  /// Replaces the manifest.
  /// @throws FileError if it cannot be written.
  void write_manifest(const Manifest& manifest) const;
  /// Compares the files with the manifest and removes the programs of which a file differs.
  void check(bool alone);
  /// Removes whole programs from the folder and from the manifest.
  void remove_programs(const std::set<std::filesystem::path>& programs, Manifest manifest);
  /// Takes the shared lock, or an exclusive one if no other process uses the folder.
  void lock();

  std::filesystem::path folder_;
  /// File descriptor.
  int lock_ = -1;
  /// True if no other process used the folder when it was opened.
  bool alone_ = true;
  std::size_t whole_ = 0, removed_ = 0;
  /// Intact files that were there when it was opened.
  std::set<std::string> found_;
};

/// State of the process's cache folder.
struct KernelCacheStatus {
  /// Folder that the driver uses; empty if no folder can be written.
  std::string folder;
  /// Reason why it is not the usual folder, or what was wrong in it; empty if all is well.
  std::string trouble;
  /// True if it was created for this process and is removed at its end.
  bool temporary = false;
};

/// Opens this process's cache folder and sets POCL_CACHE_DIR for the driver, once, before the first
/// OpenCL call. The folder is `navvy/kernels` below POCL_CACHE_DIR, XDG_CACHE_HOME or ~/.cache, the
/// first that is set, or a temporary one if that cannot be written. Not thread-safe against changes
/// of the environment.
const KernelCacheStatus& prepare_kernel_cache();
/// Lists the kernels compiled so far: calls KernelCache::seal of the process's folder.
void seal_kernel_cache() noexcept;
/// Removes the folder if it is temporary; for a process that is about to end without destructors.
void abandon_kernel_cache() noexcept;

}  // namespace navvy::device
