// SPDX-License-Identifier: Apache-2.0
// Map files for tests, and gdallocationinfo as an independent reader.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "folder.h"
#include "paths.h"
#include "scene/scene.h"

namespace navvy::heightfield::testing {

/// Returns a separate folder for each test, with a slash at its end; removed by the next call or at
/// the end of the program.
inline std::string folder() {
  static std::unique_ptr<test::Folder> own;
  own.reset();
  own = std::make_unique<test::Folder>();
  return *own / "";
}

inline std::string write_text(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// Returns ESRI ASCII text; `z(column, row from the north)` is printed as it is.
inline std::string ascii_grid(int columns, int rows, const std::string& header,
                              const std::function<std::string(int, int)>& z) {
  std::ostringstream out;
  out << "ncols " << columns << "\nnrows " << rows << "\n" << header;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) out << (c > 0 ? " " : "") << z(c, r);
    out << "\n";
  }
  return out.str();
}

inline bool has_tool(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// Runs a command line, returns its standard output.
inline std::string output_of(const std::string& command) {
  std::string out;
  std::FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return out;
  char buffer[4096];
  std::size_t n;
  while ((n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0) out.append(buffer, n);
  ::pclose(pipe);
  return out;
}

/// Returns the values that gdallocationinfo reads from `file` at file coordinates; NaN without an
/// answer.
inline std::vector<double> located(const std::string& file, const std::vector<Vec2>& points) {
  const std::string list = file + ".points";
  std::ofstream points_file(list);
  points_file.precision(17);
  for (const Vec2& p : points) points_file << p.x() << " " << p.y() << "\n";
  points_file.close();
  std::istringstream lines(
      output_of("gdallocationinfo -valonly -geoloc '" + file + "' < '" + list + "'"));
  std::vector<double> values;
  for (std::string line; std::getline(lines, line);)
    values.push_back(line.empty() ? std::nan("") : std::strtod(line.c_str(), nullptr));
  return values;
}

/// Runs the command named in a message, from its first word to a bracket, a comma or its end, with
/// these files for IN and OUT.tif. Returns true if it succeeded.
inline bool run_remedy(const std::string& message, const std::string& first, const std::string& in,
                       const std::string& out) {
  const std::size_t begin = message.find(first);
  if (begin == std::string::npos) return false;
  std::string command = message.substr(begin);
  for (const char* end : {",", ")", ";", "\n", " fills", " declares"})
    command = command.substr(0, std::min(command.size(), command.find(end)));
  const auto put = [&](const std::string& word, const std::string& file) {
    const std::size_t at = command.find(" " + word);
    if (at != std::string::npos) command.replace(at + 1, word.size(), "'" + file + "'");
  };
  put("IN", in);
  put("OUT.tif", out);
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

/// Returns a world on a map with one soil of 30 deg.
inline scene::Scene map_world(const std::string& file, double cell, Vec2 size) {
  scene::Scene world;
  world.soils.resize(1);
  world.soils[0].name = "loam";
  world.soils[0].friction_angle = radians(30);
  world.ground.layers = {{"loam", 1}};
  world.ground.file = file;
  world.ground.size = size;
  world.solver.cell = cell;
  return world;
}

inline std::string shared_data() {
  const char* given = std::getenv("NAVVY_SHARED_DATA");
  return given != nullptr ? given : navvy::source_dir() + "/../shared/data";
}

}  // namespace navvy::heightfield::testing
