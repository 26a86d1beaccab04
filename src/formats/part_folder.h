// SPDX-License-Identifier: Apache-2.0
// Writes a folder of files and replaces the old folder when it is complete.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace navvy::formats {

/// A folder that is written at a temporary place, `path`.part/<name of the folder>, and replaces
/// `path` when it is complete. Before that, and after any error, the old folder remains unchanged.
/// If `path` is a symbolic link, the link remains and its target is replaced.
class PartFolder {
 public:
  /// Creates the temporary folder, and missing folders above it. `files` are the names, relative to
  /// `path`, of all files that the format may write. An existing folder that contains any other
  /// file is not replaced.
  /// @throws InputError naming such a file, FileError naming path and cause.
  PartFolder(const std::string& path, std::vector<std::string> files);
  /// Removes the temporary folder if it was not committed.
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  /// Returns the path of the temporary folder, to which the caller writes the files. Its last
  /// component is the name of the final folder.
  std::string place() const { return place_.string(); }
  /// Replaces the old folder by the temporary one and deletes the old folder. @throws as the
  /// constructor; the old folder then remains.
  void commit();

 private:
  /// Final path as given by the caller, for messages.
  std::string path_;
  /// Names of the files that the format may write.
  std::vector<std::string> files_;
  /// Final folder with links resolved (`target_`), the folder `target_`.part (`part_`), and the
  /// temporary folder in it (`place_`).
  std::filesystem::path target_, part_, place_;
};

/// Checks that a PartFolder with these arguments can be made, without making one. @throws as the
/// constructor of PartFolder.
void require_folder(const std::string& path, const std::vector<std::string>& files);

/// Returns the last component of the path of a folder: "bag" for "out/bag/".
std::string folder_name(const std::string& path);

}  // namespace navvy::formats
