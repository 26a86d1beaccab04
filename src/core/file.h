// SPDX-License-Identifier: Apache-2.0
// Files that are either old or new, never half: write to a neighbour, flush to disk, rename.
#pragma once

#include <string>
#include <vector>

namespace navvy {

/// Replaces `path` by `content` atomically. @throws FileError naming path and cause (disk full, permission).
void write_file_atomically(const std::string& path, const std::string& content);
void write_file_atomically(const std::string& path, const std::vector<char>& content);

/// Tries, without touching `path`, whether it could be written: for what is known before a long run.
/// @throws FileError naming path and cause.
void require_writable(const std::string& path);

/// The name to write to before `commit_file`: `path` with ".part" appended.
std::string partial_name(const std::string& path);
/// Flushes `partial_name(path)` to disk and renames it to `path`. @throws FileError; the partial file is removed then.
void commit_file(const std::string& path);

/// @throws FileError naming path and cause.
std::vector<char> read_file(const std::string& path);

}  // namespace navvy
