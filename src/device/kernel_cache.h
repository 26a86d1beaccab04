// SPDX-License-Identifier: Apache-2.0
// The folder where the OpenCL driver keeps compiled kernels, checked before the driver may load
// from it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace navvy::device {

/// A folder of compiled kernels with a manifest of what lies in it.
///
/// PoCL maps the machine code that it finds in its cache into the process without a look at it: one
/// file cut short by a full disk or a kill ends every later run by SIGBUS. So Navvy gives the
/// driver a folder of its own and keeps a list of its files with their sizes and hashes. Opening
/// the folder removes the kernels of which one file differs from the list, and the driver compiles
/// them anew; `seal` lists what it has compiled. Nothing is stored twice.
///
/// Several processes may use one folder: each holds a shared lock on it while it lives. Files that
/// no list knows are removed only when nobody else is there, for they are then left over from a
/// process that was killed; beside others they may be those that a neighbour has just compiled.
class KernelCache {
 public:
  /// Makes the folder if needed, takes the lock and checks the files. Costs one reading of the
  /// folder (a few MB).
  /// @throws FileError naming folder and cause when it cannot be made, locked or written, or its
  /// disk is nearly full.
  explicit KernelCache(const std::filesystem::path& folder);
  /// Seals and unlocks.
  ~KernelCache();
  KernelCache(const KernelCache&) = delete;
  KernelCache& operator=(const KernelCache&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  /// Files found whole, and files of the kernels that were removed as something about them was
  /// wrong, when it opened.
  std::size_t whole() const { return whole_; }
  std::size_t removed() const { return removed_; }

  /// Lists the files that are new since the folder was opened, also those that a neighbour has
  /// listed, whose places this process's own may have taken. Never throws: a list that cannot be
  /// written only makes the next process compile again.
  void seal() noexcept;

  /// Name of the lock file: a folder that holds it is one of ours.
  static constexpr const char* kLockName = "navvy.lock";

 private:
  struct Entry {
    std::uintmax_t size = 0;
    std::string hash;  ///< 16 hex digits
  };
  using Manifest = std::map<std::string, Entry>;  ///< by path relative to the folder

  Manifest read_manifest() const;
  void write_manifest(const Manifest& manifest) const;
  void check(bool alone);
  void remove_programs(const std::set<std::filesystem::path>& programs, Manifest manifest);
  void lock();

  std::filesystem::path folder_;
  int lock_ = -1;      ///< file descriptor
  bool alone_ = true;  ///< nobody else used the folder when it was opened
  std::size_t whole_ = 0, removed_ = 0;
  std::set<std::string> found_;  ///< files that were there, and whole, when it opened
};

/// What happened to the process's own cache folder.
struct KernelCacheStatus {
  std::string folder;  ///< what the driver was given; empty when no folder can be written
  /// Why it is not the usual one, or what was wrong in it; empty when all is well.
  std::string trouble;
  bool temporary = false;  ///< made for this process and removed at its end
};

/// Opens this process's cache folder and tells the driver (POCL_CACHE_DIR), once; the first call
/// into OpenCL comes after it. The folder is `navvy/kernels` below POCL_CACHE_DIR, XDG_CACHE_HOME
/// or ~/.cache, the first that is set; where that cannot be written, a temporary one. Not
/// thread-safe against changes of the environment.
const KernelCacheStatus& prepare_kernel_cache();
/// Lists the kernels compiled so far (KernelCache::seal of the process's folder).
void seal_kernel_cache() noexcept;
/// Removes the folder if it was a temporary one: for a process that is about to end without its
/// destructors.
void abandon_kernel_cache() noexcept;

}  // namespace navvy::device
