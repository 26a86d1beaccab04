// SPDX-License-Identifier: Apache-2.0
// A text format of rows from north to south. Written to a file beside the target and renamed at the
// end, so that a reader never meets half a map.
#include "heightfield/esri_ascii.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "heightfield/file_rows.h"

namespace navvy::heightfield {
namespace {

// Shortest text that reads back to the same number.
template <class T>
void append(std::string& out, T value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, end.ptr);
}

// Corner and cell in the file's own coordinates; the format knows square cells and no CRS.
std::string header(const Terrain& terrain) {
  const GroundSetup& setup = terrain.setup();
  std::string out = "ncols " + std::to_string(terrain.nx()) + "\nnrows " +
                    std::to_string(terrain.ny()) + "\nxllcorner ";
  append(out, setup.easting);
  out += "\nyllcorner ";
  append(out, setup.northing);
  out += "\ncellsize ";
  append(out, setup.cell / setup.file_unit);
  out += "\nNODATA_value ";
  append(out, kExportNodata);
  return out + "\n";
}

}  // namespace

void write_esri_ascii(const Terrain& terrain, const std::string& path) {
  const std::string part = partial_name(path);
  // Nothing is left behind by a failure.
  const auto fail = [&](int code) {
    ::unlink(part.c_str());
    throw FileError("cannot write '" + path + "': " + std::strerror(code));
  };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(part.c_str(), "wb"), std::fclose);
  if (!file) fail(errno);
  const auto write = [&](const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) fail(errno);
  };
  write(header(terrain));
  // North first; 32 rows at a time because that is how the ground keeps them.
  std::vector<float> rows;
  for (int bottom = (terrain.ny() - 1) / 32 * 32; bottom >= 0; bottom -= 32) {
    const int top = std::min(bottom + 32, terrain.ny());
    file_rows(terrain, bottom, top, rows);
    for (int iy = top - 1; iy >= bottom; --iy) {
      std::string line;
      const float* row = rows.data() + static_cast<std::size_t>(iy - bottom) * terrain.nx();
      for (int ix = 0; ix < terrain.nx(); ++ix) {
        if (ix > 0) line += ' ';
        append(line, row[ix]);
      }
      line += '\n';
      write(line);
    }
  }
  // A full disk may show only here.
  if (std::fclose(file.release()) != 0) fail(errno);
  commit_file(path);
}

}  // namespace navvy::heightfield
