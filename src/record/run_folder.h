// SPDX-License-Identifier: Apache-2.0
// The folder that a run writes its results to, with a list of the files that runs have written
// there. A run removes and replaces only files on that list.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace navvy::record {

/// A folder for results, which only one run at a time may use.
///
/// The marker file `navvy.run` in the folder is a lock and a list: it is locked while the run
/// exists, and the name of every result file is added to it before that file is written. When a run
/// begins, the files that the previous run listed are moved to "<folder>.previous", and the older
/// results that were listed there are removed. Files that are on no list are never changed.
class RunFolder {
 public:
  /// Locks the folder `directory`, which is created with its parent folders if necessary. Changes
  /// no file except the marker file. `reads` holds the paths of files that the run reads, such as
  /// its scene.
  /// @throws InputError if another run uses the folder; if the folder or "<folder>.previous"
  /// contains a file that this run would write but no run has listed; or if one of the files in
  /// `reads` would be removed.
  /// @throws FileError if the folder cannot be created or written to.
  explicit RunFolder(const std::string& directory, const std::vector<std::string>& reads = {});
  /// Unlocks the folder. If `begin` was not called, also removes the marker file and the folders
  /// that the constructor created.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Moves the results of the previous run to "<folder>.previous" and starts a new list. If the
  /// process is killed during the move, the next run completes it.
  /// @throws FileError if a file cannot be moved or removed.
  void begin();
  /// Adds a result file to the list, creates the folders in which it lies, and returns its path.
  /// `name` is relative to the run's folder: "summary.json", "frames/left_00001.png".
  /// @throws FileError if a file of that name exists that this run has not listed, if the list
  /// cannot be written, or if the folder is not `intact()`; Error for a name that leads out of the
  /// folder.
  std::string path(const std::string& name);
  /// Returns true if `directory()` still names the folder that this object locked, with its marker
  /// file: it was not removed, moved, emptied or replaced by another folder or a link to one.
  bool intact() const;
  /// Locks a new folder for the rest of the results, with a new list: "<folder>.saved-XXXXXX", or
  /// one of the temporary files if that cannot be made. `directory()` and `path()` refer to it from
  /// then on; the former folder is left alone. Returns the path of the new folder.
  /// @throws FileError if no folder can be made.
  std::string move_out();
  /// Returns the path of the folder, without a slash at its end.
  const std::string& directory() const { return directory_; }

  /// Returns true if `name` is one of the file names that every run writes directly into its
  /// folder, such as "summary.json", or the name of the marker file.
  static bool writes(const std::string& name);

  /// Name of the marker file.
  static constexpr const char* kMarker = "navvy.run";

 private:
  /// An open marker file with the names that it lists.
  struct Marker;
  /// Checks that `folder` contains no file with the name of a result that is missing from the list
  /// in `marker`.
  /// @throws InputError if it does.
  void require_free(const Marker& marker, const std::string& folder) const;
  /// Checks that none of the files in `reads` is a listed result in `folder`, which would be
  /// removed.
  /// @throws InputError if one is.
  void require_unread(const Marker& marker, const std::string& folder,
                      const std::vector<std::string>& reads) const;
  /// Replaces the contents of the marker file of `folder`, open as the descriptor `file`, by the
  /// list `names`. `moving` marks that results are being moved into the folder.
  void write_list(const std::string& folder, int file, const std::set<std::string>& names,
                  bool moving) const;
  /// Opens and locks the marker file of `folder` and reads its list. If the file does not exist, it
  /// is created if `make` is true; otherwise the result has no open file.
  /// @throws InputError if another run has locked it or it has an unknown format; FileError if it
  /// cannot be opened.
  Marker open_marker(const std::string& folder, bool make) const;
  /// Closes and unlocks the marker file of "<folder>.previous", if it is open.
  void close_previous();
  /// Unlocks the folder. If `begin` was not called, also removes what this object created.
  void leave();

  /// Path of the folder, and path of "<folder>.previous".
  std::string directory_, previous_;
  /// Folders that the constructor created, innermost first.
  std::vector<std::string> made_;
  /// True if the marker file was empty when it was opened: no run has written to it.
  bool unused_ = false;
  /// True if `begin` was called.
  bool begun_ = false;
  /// Descriptors of the locked marker files of the folder and of "<folder>.previous"; -1 if not
  /// open.
  int lock_ = -1, previous_lock_ = -1;
  /// Descriptor of the folder, for its identity; -1 if not open.
  int place_ = -1;
  /// Listed result files of the folder and of "<folder>.previous", relative to these folders.
  std::set<std::string> listed_, previous_listed_;
  /// True if an earlier move to "<folder>.previous" was interrupted.
  bool previous_moving_ = false;
};

}  // namespace navvy::record
