// SPDX-License-Identifier: Apache-2.0
// Whose files lie in a run's folder: a run removes and replaces what runs wrote, nothing else.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace navvy::record {

/// A folder that one run at a time owns.
///
/// The file `navvy.run` in it is both lock and list: it is locked while the run lives, and names
/// every file before it is written. What an earlier run listed moves to "<folder>.previous" when
/// the next one begins, and is removed from there by the one after; files that no list names are
/// never touched, whatever they are called.
class RunFolder {
 public:
  /// Takes the folder, making it and those above it if need be; nothing in it changes yet but for
  /// the marker.
  /// @param reads files that the run goes on from or reads; none may be among those that are about
  /// to be removed
  /// @throws InputError when another run owns it, when it or "<folder>.previous" holds a file of
  /// somebody else where this run would write, or one of `reads`; FileError when it cannot be made
  /// or written.
  explicit RunFolder(const std::string& directory, const std::vector<std::string>& reads = {});
  /// Unlocks. What was taken and not used is left as it was found: the marker and the folders that
  /// were made go again.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Moves what the run before left to "<folder>.previous" and starts a new list. A kill in between
  /// loses nothing: the next run goes on with the moving. @throws FileError.
  void begin();
  /// Path of the file `name`, "summary.json" or "frames/left_00001.png", listed as this run's from
  /// now on.
  /// @throws FileError when somebody else has put a file there since, or the list cannot be
  /// written.
  std::string path(const std::string& name);
  /// Without a slash at its end.
  const std::string& directory() const { return directory_; }

  /// Whether every run has a file of this name in its folder, or may have.
  static bool writes(const std::string& name);

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
  /// Unlocks; without a run that has begun, also removes what this object made.
  void leave();

  std::string directory_, previous_;
  std::vector<std::string> made_;  ///< the folders that were not there before, the innermost first
  bool unused_ = false;            ///< no run has written into the marker
  bool begun_ = false;             ///< files may be written
  int lock_ = -1, previous_lock_ = -1;
  std::set<std::string> listed_, previous_listed_;
  bool previous_moving_ = false;  ///< an earlier move did not come to its end
};

}  // namespace navvy::record
