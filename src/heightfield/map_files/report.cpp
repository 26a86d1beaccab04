// SPDX-License-Identifier: Apache-2.0
// Prints the findings in a map as lines for people, with as many digits as a surveyor would give.
#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "heightfield/map_files/import.h"

namespace navvy::heightfield {
namespace {

__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  char buffer[512];
  va_list args;
  va_start(args, format);
  std::vsnprintf(buffer, sizeof buffer, format, args);
  va_end(args);
  return std::string(buffer) + "\n";
}

}  // namespace

// One line per property, aligned for terminals.
std::string TerrainReport::text() const {
  std::string out = "terrain " + file + "\n";
  out += line("  source   %s, %d x %d cells of %.6g x %.6g m%s", format.c_str(), columns, rows,
              cell_x, cell_y, point_registered ? ", registered at points" : "");
  out += "  CRS      " + (crs.empty() ? std::string("none") : crs) + "\n";
  out += line("  units    %s (%.12g m), heights %s (%.12g m)", unit.c_str(), metres,
              height_unit.c_str(), height_metres);
  out += line("  extent   x %.3f .. %.3f, y %.3f .. %.3f", file_min.x(), file_max.x(), file_min.y(),
              file_max.y());
  out += line("  site     x %.3f .. %.3f, y %.3f .. %.3f, resampled to %.4g m", site_min.x(),
              site_max.x(), site_min.y(), site_max.y(), soil_cell);
  out += line("  origin   local origin at %.4f, %.4f; W z = height - %.4f m", site_min.x(),
              site_min.y(), height_offset);
  out += line("  heights  %.3f .. %.3f m", lowest, highest);
  if (nodata.gaps == 0)
    out += line("  nodata   %s, no such cell here", nodata_value.c_str());
  else
    out += line(
        "  nodata   %s: %lld of %lld cells on the site (%.3g %%), filled from up to %.3g m away",
        nodata_value.c_str(), static_cast<long long>(site_gaps), static_cast<long long>(site_cells),
        100 * share_filled(), filled_from());
  out += line("  slopes   %.1f .. %.1f deg, median %.1f; %.2f %% above the repose of %.1f deg",
              degrees(slope.least), degrees(slope.most), degrees(slope.median),
              100 * slope.share_above, degrees(repose));
  for (const std::string& note : notes) out += "  note     " + note + "\n";
  return out;
}

double TerrainReport::share_filled() const {
  return site_cells > 0 ? static_cast<double>(site_gaps) / static_cast<double>(site_cells) : 0;
}

double TerrainReport::filled_from() const { return nodata.farthest * std::max(cell_x, cell_y); }

// One line, because runs print it among others.
std::string TerrainReport::warning() const {
  if (site_gaps == 0) return "";
  std::string out = line(
      "%lld of %lld map cells on the site (%.3g %%, %.3g m2) have no height and were filled from "
      "their neighbours, from up to %.3g m away",
      static_cast<long long>(site_gaps), static_cast<long long>(site_cells), 100 * share_filled(),
      static_cast<double>(site_gaps) * cell_x * cell_y, filled_from());
  out.pop_back();
  std::string remedy = for_gdal ? "gdal_fillnodata.py IN OUT.tif fills them beforehand"
                                : "scipy.interpolate.griddata fills them before numpy.save";
  if (unmarked > 0) {
    char value[32];
    std::snprintf(value, sizeof value, "%.9g", unmarked_value);
    out += std::string("; ") + value +
           " cannot be a height of ground, and the file does not declare it as nodata";
    if (for_gdal)
      remedy =
          std::string("gdal_translate -a_nodata ") + value + " IN OUT.tif declares it, " + remedy;
  }
  return file + ": " + out + " (" + remedy + ", --at moves the site)";
}

}  // namespace navvy::heightfield
