// SPDX-License-Identifier: Apache-2.0
#include "device/source.h"

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

#include "core/file.h"
#include "device/embedded_private.h"

namespace navvy::device {
namespace {

/// The file an include line names; empty when the line is none.
std::string included_path(const std::string& line) {
  std::size_t at = line.find_first_not_of(" \t");
  // The same leniency about blanks as a compiler's, so that a file which another tool accepts is
  // not taken in silence without its include. An include in angle brackets is none of ours.
  if (at == std::string::npos || line[at] != '#') return "";
  at = line.find_first_not_of(" \t", at + 1);
  if (at == std::string::npos || line.compare(at, 7, "include") != 0) return "";
  const std::size_t open = line.find_first_not_of(" \t", at + 7);
  if (open == std::string::npos || line[open] != '"') return "";
  const std::size_t close = line.find('"', open + 1);
  return close == std::string::npos ? "" : line.substr(open + 1, close - open - 1);
}

bool is_pragma_once(const std::string& line) { return line.compare(0, 12, "#pragma once") == 0; }

// The order is that of reading, depth first, as a compiler would see it. Each file counts once for
// the whole program, so a header that two files include needs no guard in the kernel language.
void expand(const std::string& path, const std::string& text, std::set<std::string>& seen,
            std::string& out) {
  seen.insert(path);
  out += "#line 1 \"" + path + "\"\n";
  std::istringstream lines(text);
  std::string line;
  // The number of lines is kept, one for one, so that a build log's numbers are those of the file.
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string child = included_path(line);
    if (child.empty()) {
      // The whole program is one text for the driver, where "once" would only warn.
      out += is_pragma_once(line) ? "\n" : line + "\n";
      continue;
    }
    if (seen.count(child) == 0) {
      std::string child_text;
      try {
        child_text = kernel_source(child);
      } catch (const DeviceError& error) {
        throw DeviceError(path + ":" + std::to_string(number) + ": " + error.what());
      }
      expand(child, child_text, seen, out);
    }
    out += "#line " + std::to_string(number + 1) + " \"" + path + "\"\n";
  }
}

}  // namespace

std::string kernel_source(const std::string& path) {
  const char* folder = std::getenv("NAVVY_KERNEL_DIR");
  // Read anew at every call: edit a kernel, run again, no build in between.
  if (folder != nullptr && *folder != '\0') {
    try {
      const std::vector<char> text = read_file(std::string(folder) + "/" + path);
      return std::string(text.begin(), text.end());
    } catch (const FileError& error) {
      throw DeviceError(std::string("kernel file: ") + error.what() +
                        " (the folder comes from the environment variable NAVVY_KERNEL_DIR)");
    }
  }
  // The list is short, and a program asks for a few files, so no map is kept.
  for (const EmbeddedFile* file = embedded_files(); file->path != nullptr; ++file) {
    if (path == file->path) return file->text;
  }
  throw DeviceError("no kernel file '" + path +
                    "' was embedded by the build (it looks in kernels/)");
}

std::vector<std::string> kernel_paths() {
  std::vector<std::string> paths;
  for (const EmbeddedFile* file = embedded_files(); file->path != nullptr; ++file)
    paths.emplace_back(file->path);
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string expand_includes(const std::string& path, const std::string& text) {
  std::set<std::string> seen;
  std::string out;
  expand(path, text, seen, out);
  return out;
}

}  // namespace navvy::device
