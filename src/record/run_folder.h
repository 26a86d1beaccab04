// SPDX-License-Identifier: Apache-2.0
// Whose files are in a run's folder: a run removes and replaces what runs wrote, nothing else.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace navvy::record {

/// A folder of results that one run at a time owns.
///
/// The file `navvy.run` in it is lock and list: it is locked while the run exists, and names every
/// file before that file is written. When a run begins, the files that the previous run listed move
/// to "<folder>.previous", and those that were there before are removed. Files that no list names
/// are never touched.
class RunFolder {
 public:
  /// Locks the folder; makes it and its parents if necessary. Changes nothing but the marker file.
  /// `reads` are files that the run reads, such as its scene. @throws InputError when another run
  /// owns the folder, when the folder or "<folder>.previous" holds a file of another origin where
  /// this run would write, or when one of `reads` would be removed; FileError when the folder
  /// cannot be made or written.
  explicit RunFolder(const std::string& directory, const std::vector<std::string>& reads = {});
  /// Unlocks the folder. If no run began, removes the marker file and the folders that the
  /// constructor made.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Moves the results of the previous run to "<folder>.previous" and starts a new list. After a
  /// kill in between, the next run continues the move. @throws FileError.
  void begin();
  /// Adds a file to the list and returns its path. `name` is relative to the folder:
  /// "summary.json", "frames/left_00001.png". Makes folders for it. @throws FileError when a file
  /// of another origin exists there, or the list cannot be written; Error for a name that leads out
  /// of the folder.
  std::string path(const std::string& name);
  /// Returns the path of the folder, without a slash at its end.
  const std::string& directory() const { return directory_; }

  /// Returns true if runs write a file of this name into their folder.
  static bool writes(const std::string& name);

  /// Name of the marker file.
  static constexpr const char* kMarker = "navvy.run";

 private:
  struct Marker;
  void require_free(const Marker& marker, const std::string& folder) const;
  void require_unread(const Marker& marker, const std::string& folder,
                      const std::vector<std::string>& reads) const;
  void write_list(const std::string& folder, int file, const std::set<std::string>& names,
                  bool moving) const;
  /// Opens and locks the list of `folder`. @throws InputError when a run holds it, FileError.
  Marker open_marker(const std::string& folder, bool make) const;
  void close_previous();
  /// Unlocks. If no run began, also removes what this object made.
  void leave();

  std::string directory_, previous_;
  std::vector<std::string> made_;  ///< folders that the constructor made, innermost first
  bool unused_ = false;            ///< no run has written to the marker file
  bool begun_ = false;             ///< `begin` was called
  int lock_ = -1, previous_lock_ = -1;
  std::set<std::string> listed_, previous_listed_;
  bool previous_moving_ = false;  ///< an earlier move was interrupted
};

}  // namespace navvy::record
