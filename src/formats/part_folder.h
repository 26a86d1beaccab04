// SPDX-License-Identifier: Apache-2.0
// A folder of files that replaces an earlier one as a whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace navvy::formats {

/// Writes to a folder of the same name in `path`.part/ and exchanges it for the old one when it is
/// complete. Until then, and after any error, the old folder stands. A symbolic link stays; its
/// target is replaced.
class PartFolder {
 public:
  /// Makes the folder and those above it. `files` are the names below `path` that belong to the
  /// format; a folder that holds any other file is not touched.
  /// @throws InputError naming the foreign file, FileError naming path and cause.
  PartFolder(const std::string& path, std::vector<std::string> files);
  /// Removes a folder that was not committed.
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  /// Returns the empty folder to write to; its last name is that of `path`.
  std::string place() const { return place_.string(); }
  /// Exchanges it for the old folder and removes that. @throws as the constructor; the old folder
  /// stands then.
  void commit();

 private:
  std::string path_;
  std::vector<std::string> files_;
  std::filesystem::path target_, part_, place_;
};

/// Checks that a PartFolder could be made, without making one. @throws as its constructor.
void require_folder(const std::string& path, const std::vector<std::string>& files);

/// Returns the last name of a folder's path: "bag" for "out/bag/".
std::string folder_name(const std::string& path);

}  // namespace navvy::formats
