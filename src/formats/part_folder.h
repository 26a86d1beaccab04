// SPDX-License-Identifier: Apache-2.0
// A folder of files that takes the place of an earlier one as a whole.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace navvy::formats {

/// Writes to a folder of the same name in `path`.part/ and takes its place when it is whole; until
/// then, and where anything fails, the old folder stands. A symbolic link stays: what it leads to
/// is replaced.
class PartFolder {
 public:
  /// `files` are the names below `path` that are ours: a folder that holds any other file is not
  /// touched. Folders above `path` are made. @throws InputError naming the file that is not ours,
  /// FileError naming path and cause.
  PartFolder(const std::string& path, std::vector<std::string> files);
  /// Removes what was not committed.
  ~PartFolder();
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  /// Where to write: an empty folder, called as `path` is.
  std::string place() const { return place_.string(); }
  /// Exchanges it for the old one, which goes. @throws as the constructor; the old folder stands
  /// then.
  void commit();

 private:
  std::string path_;
  std::vector<std::string> files_;
  std::filesystem::path target_, part_, place_;
};

/// Whether a PartFolder could be made, without making one. @throws as its constructor.
void require_folder(const std::string& path, const std::vector<std::string>& files);

/// The last name of a folder's path: "bag" of "out/bag/".
std::string folder_name(const std::string& path);

}  // namespace navvy::formats
