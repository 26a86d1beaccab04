// SPDX-License-Identifier: Apache-2.0
// Files that are replaced atomically: write to a neighbouring file, flush it to disk, rename it.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace navvy {

/// Replaces the file at `path` by `content` atomically. A crash in between leaves either the old or
/// the new file. If `path` is a symbolic link, its target is replaced. Waits for the disk, some
/// milliseconds at least: do not call it in a time step.
/// @throws FileError naming path and cause (disk full, permission, no such folder), and if `path`
/// exists but is no regular file: a pipe, a socket, a device or a folder is left as it is.
void write_file_atomically(const std::string& path, const std::string& content);
void write_file_atomically(const std::string& path, const std::vector<char>& content);

/// Checks, without touching `path`, whether it could be written; call it before a long run. It does
/// not check whether the disk has space for the content.
/// @throws FileError like write_file_atomically.
void require_writable(const std::string& path);

/// Returns the path that a write to `path` reaches: `path` itself, or the target if it is a
/// symbolic link, whether the target exists or not. Returns `path` if links form a circle.
std::string followed(const std::string& path);
/// Returns the name to write to before `commit_file`: `followed(path)` with ".part" appended. It is
/// in the same folder, since a rename across file systems is not atomic. Two processes that write
/// the same path share this name and may damage each other's file.
std::string partial_name(const std::string& path);
/// Flushes `partial_name(path)` to disk and renames it to `followed(path)`.
/// @throws FileError on failure or if `path` exists but is no regular file; the partial file is
/// removed then.
void commit_file(const std::string& path);

/// Refuses a path that is no regular file (links are followed): reading a pipe would block, and a
/// device may have no end. A missing path is accepted.
/// @throws FileError naming the path and what it is.
void require_regular(const std::string& path);

/// Returns true if both paths lead to the same existing file, however they are spelt. An empty path
/// leads to none.
bool same_file(const std::string& a, const std::string& b);

/// Reads a whole file into memory.
/// @throws FileError naming path and cause if the file is missing, is no regular file or has more
/// than `most` bytes; the size is checked before the content is read.
std::vector<char> read_file(const std::string& path,
                            std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace navvy
