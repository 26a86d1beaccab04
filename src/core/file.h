// SPDX-License-Identifier: Apache-2.0
// Files that are either old or new, never half: write to a neighbour, flush to disk, rename.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace navvy {

/// Replaces `path` by `content` atomically. A crash or a kill in between leaves the old file or the
/// new one. A symbolic link stays: what it leads to is replaced. Waits for the disk, some
/// milliseconds at least: not for use in a step.
/// @throws FileError naming path and cause (disk full, permission, no such folder), and for what is
/// there and is no plain file: a pipe, a socket, a device or a folder stays what it is.
void write_file_atomically(const std::string& path, const std::string& content);
void write_file_atomically(const std::string& path, const std::vector<char>& content);

/// Tries, without touching `path`, whether it could be written: for what is known before a long
/// run. Whether there is room for the content is not known then.
/// @throws FileError as write_file_atomically.
void require_writable(const std::string& path);

/// Where what is written to `path` comes to lie: `path`, or where that is a symbolic link what it
/// leads to, whether that is there or not. Links in a circle lead to `path`.
std::string followed(const std::string& path);
/// The name to write to before `commit_file`: `followed(path)` with ".part" appended. It lies in
/// the same folder, as a rename across file systems is not atomic. Two processes that write one
/// path at a time share this name and may spoil each other's file.
std::string partial_name(const std::string& path);
/// Flushes `partial_name(path)` to disk and renames it to `followed(path)`. @throws FileError, also
/// for what is there and is no plain file; the partial file is removed then.
void commit_file(const std::string& path);

/// Refuses what is not a plain file (links are followed): a pipe would wait for a writer, a device
/// may have no end. What is not there is left to whoever opens it. @throws FileError naming path
/// and what it is.
void require_regular(const std::string& path);

/// Whether two paths lead to one file that is there, however they are spelt. An empty path leads to
/// none.
bool same_file(const std::string& a, const std::string& b);

// The whole file as bytes, in memory at once. A file that does not exist is an error, never an
// empty answer.
/// @throws FileError naming path and cause; also of what is no plain file, and of more than `most`
/// bytes, before they are in memory.
std::vector<char> read_file(const std::string& path,
                            std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace navvy
