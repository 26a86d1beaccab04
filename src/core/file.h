// SPDX-License-Identifier: Apache-2.0
// Atomic replacement of files: the content is written to a new file in the same folder, flushed to
// disk, and renamed. Also reading and checks of paths.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace navvy {

/// Replaces the file at `path` by a file with this content. After a crash, either the old or the
/// new file exists completely. If `path` is a symbolic link, its target is replaced. Waits for the
/// disk, at least some milliseconds, so do not call it in a time step.
/// @throws FileError naming path and cause (disk full, no permission, no such folder), also if
/// `path` exists but is not a regular file: a pipe, socket, device or folder is left unchanged
void write_file_atomically(const std::string& path, const std::string& content);
/// Replaces the file at `path` atomically by a file with these bytes, like the function above for
/// text.
void write_file_atomically(const std::string& path, const std::vector<char>& content);

/// Checks that `path` could be written, without changing it. Call it before a long run. It does not
/// check whether the disk has enough space.
/// @throws FileError if it could not, as write_file_atomically does
void require_writable(const std::string& path);

/// Returns the path of the file that a write to `path` would change: the target if `path` is a
/// symbolic link, whether the target exists or not; otherwise `path`. Returns `path` if links form
/// a circle.
std::string followed(const std::string& path);
/// Returns the path of the temporary file for `commit_file`: `followed(path)` with ".part"
/// appended. It is in the same folder as the final file, since a rename between file systems is not
/// atomic. Two processes that write the same path use the same temporary file and may damage each
/// other's content.
std::string partial_name(const std::string& path);
/// Flushes `partial_name(path)`, which the caller has written, to disk and renames it to
/// `followed(path)`.
/// @throws FileError if that fails or `path` exists but is not a regular file; the temporary file
/// is then removed
void commit_file(const std::string& path);

/// Checks that `path` is a regular file or does not exist; symbolic links are followed. Reading a
/// pipe would block, and a device may have no end.
/// @throws FileError naming the path and its file type, if it is something else
void require_regular(const std::string& path);

/// Returns true if both paths refer to the same existing file, even if they are spelled
/// differently; false if one of them is empty or refers to no file.
bool same_file(const std::string& a, const std::string& b);

/// Returns the content of a file.
/// @throws FileError naming path and cause if the file is missing, is not a regular file or is
/// larger than `most` bytes; at most that many bytes are kept in memory
std::vector<char> read_file(const std::string& path,
                            std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace navvy
