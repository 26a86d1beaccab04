// SPDX-License-Identifier: Apache-2.0
// The cells of a map file as heights: converts units and gaps, subtracts a whole number of metres,
// and reads all cells or windows of them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/limits.h"
#include "heightfield/map_files/map_file.h"

namespace navvy::heightfield {
namespace {

// Cells around the site, for interpolation and for filling gaps at its edge.
constexpr int kMargin = 2;
// No ground is above or below this; such a number is an undeclared nodata value [m].
constexpr double kHighest = 12000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Detects heights that are whole numbers of a unit only: a staircase, unless all are equal.
class Staircase {
 public:
  explicit Staircase(double unit) : unit_(unit) {}
  void look(double height) {
    if (whole_) {
      // Avoids std::round, because 10^8 cells are checked. A float of a whole metre in feet is off
      // by less.
      const double steps = height / unit_;
      const auto nearest = static_cast<std::int64_t>(steps + (steps < 0 ? -0.5 : 0.5));
      whole_ = std::abs(steps - static_cast<double>(nearest)) < 1e-4;
    }
    least_ = std::min(least_, height);
    most_ = std::max(most_, height);
  }
  bool found() const { return whole_ && most_ - least_ > 0.5 * unit_; }

 private:
  double unit_, least_ = kHighest, most_ = -kHighest;
  bool whole_ = true;
};

// A wheel would roll over these steps; the note describes how to smooth them.
void note_staircase(MapFile& map, const std::string& unit, double metres) {
  TerrainReport& report = map.report;
  // Means of several cells lie between two steps, and bilinear heights between them have the slopes
  // of the ground.
  const double wide = 4 * std::max(map.step_x, map.step_y);
  report.notes.push_back(
      "all heights are whole numbers of the " + unit + ": a staircase with steps of " +
      number_text(metres, "%.4g") + " m; get them with decimals, or smooth them: " +
      (report.for_gdal ? "gdalwarp -ot Float32 -r average -tr " + number_text(wide) + " " +
                             number_text(wide) + " IN OUT.tif"
                       : "scipy.ndimage.uniform_filter before numpy.save"));
}

// Converts the values of a file to metres, and every spelling of "no data" to NaN.
class Decoder {
 public:
  explicit Decoder(MapFile& map) {
    const RasterHeader& header = map.header;
    if (header.nodata) nodata_ = static_cast<float>(*header.nodata);
    has_nodata_ = header.nodata.has_value();
    map.report.nodata_value =
        header.nodata ? "declared as " + number_text(*header.nodata) : "none declared";
    // Readers do not apply scale and offset themselves.
    if (header.scale && std::isfinite(*header.scale) && *header.scale != 0) scale_ = *header.scale;
    if (header.offset && std::isfinite(*header.offset)) offset_ = *header.offset;
    // Black and white of a picture.
    if (map.scale.has_heights) {
      offset_ = map.scale.low;
      scale_ = (map.scale.high - map.scale.low) / (header.has_bytes ? 255 : 65535);
    }
    metres_ = map.report.height_metres;
  }
  double operator()(double raw) const {
    if (is_nodata(raw)) return kNaN;
    // A height that no ground has is undeclared nodata.
    const double height = (raw * scale_ + offset_) * metres_;
    return std::abs(height) <= kHighest ? height : kNaN;
  }
  /// Returns true for nodata as the file declares it, and for the usual undeclared spellings.
  bool is_nodata(double raw) const {
    // Compared in float32: a double that went through a float file is no longer equal.
    const auto single = static_cast<float>(raw);
    if (std::isnan(single) || (has_nodata_ && single == nodata_)) return true;
    constexpr double usual[] = {-9999.0, -9999.005859375, -32768.0, -32767.0};
    return raw <= usual[0] && std::find(std::begin(usual), std::end(usual), raw) != std::end(usual);
  }

 private:
  bool has_nodata_ = false;
  float nodata_ = 0;
  double scale_ = 1, offset_ = 0, metres_ = 1;
};

/// A few bytes may decode to gigabytes, and blocks that do not fit into the cache of GDAL together
/// are decoded again for every row.
void check_blocks(const MapFile& map, int x0, int x1, int y0, int y1) {
  const int blocks_x = x1 / map.header.block_x - x0 / map.header.block_x + 1,
            blocks_y = y1 / map.header.block_y - y0 / map.header.block_y + 2;
  const double across = blocks_x, down = blocks_y;
  const bool cached = across * map.header.block_bytes <= static_cast<double>(kBlockCacheBytes);
  const double decoded = across * (cached ? down : y1 - y0 + 1.0) * map.header.block_bytes;
  if (decoded > limits::kMapDecodedBytes)
    map.fail("", number_text(decoded) + " bytes",
             "more than " + number_text(limits::kMapDecodedBytes) +
                 " to decode for this site: its blocks hold far more than the site",
             "rewrite it with gdal_translate -co TILED=YES");
}

/// The cells of a file that are read, and their conversion to our order.
struct Cut {
  /// Cells of the map in Navvy's order, the last ones inclusive.
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  /// Size of the whole file.
  int columns = 0, rows = 0;
  bool columns_fall = false, rows_fall = true;
};

/// Returns the cells that the site needs, with a margin; clamped in double, because a damaged
/// header may give any number.
Cut cut_of(const MapFile& map, const Vec2& corner, const Vec2& size) {
  const TerrainReport& report = map.report;
  const auto first = [](double x, double cell, int n) {
    return static_cast<int>(std::clamp(std::floor(x / cell) - kMargin, 0.0, n - 1.0));
  };
  const auto last = [](double x, double cell, int n) {
    return static_cast<int>(std::clamp(std::floor(x / cell) + kMargin, 0.0, n - 1.0));
  };
  return {first(corner.x(), report.cell_x, report.columns),
          first(corner.y(), report.cell_y, report.rows),
          last(corner.x() + size.x(), report.cell_x, report.columns),
          last(corner.y() + size.y(), report.cell_y, report.rows),
          report.columns,
          report.rows,
          map.columns_fall,
          map.rows_fall};
}

/// Returns the raster of a cut without its heights.
HeightRaster frame_of(const TerrainReport& report, const Cut& cut, const Vec2& corner) {
  HeightRaster raster;
  raster.nx = cut.x1 - cut.x0 + 1;
  raster.ny = cut.y1 - cut.y0 + 1;
  raster.cell_x = report.cell_x;
  raster.cell_y = report.cell_y;
  raster.x0 = (cut.x0 + 0.5) * report.cell_x - corner.x();
  raster.y0 = (cut.y0 + 0.5) * report.cell_y - corner.y();
  return raster;
}

/// Returns cells of the cut, counted from its first, in columns and rows of the file.
CellRect in_file(const Cut& cut, const CellRect& cells) {
  const int nx = cells.x1 - cells.x0, ny = cells.y1 - cells.y0;
  const int column = cut.columns_fall ? cut.columns - (cut.x0 + cells.x1) : cut.x0 + cells.x0;
  const int row = cut.rows_fall ? cut.rows - (cut.y0 + cells.y1) : cut.y0 + cells.y0;
  return {column, row, column + nx, row + ny};
}

/// Reads raw numbers of some cells of the cut, counted from its first, x fastest. @throws RowError
/// where the file cannot be read.
void read_raw(RasterSource& source, const Cut& cut, const CellRect& cells,
              std::vector<double>& raw) {
  const int nx = cells.x1 - cells.x0, ny = cells.y1 - cells.y0;
  raw.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
  source.read(in_file(cut, cells), raw.data());
  const auto line = [&](int y) { return raw.begin() + static_cast<std::ptrdiff_t>(y) * nx; };
  for (int y = 0; cut.columns_fall && y < ny; ++y) std::reverse(line(y), line(y + 1));
  for (int y = 0; cut.rows_fall && y < ny / 2; ++y)
    std::swap_ranges(line(y), line(y + 1), line(ny - 1 - y));
}

/// Collects heights as they come out of the file: counts them, takes their mean, notes oddities.
class Intake {
 public:
  Intake(MapFile& map)
      : map_(map), decode_(map), in_units_(map.report.height_metres), in_metres_(1) {}
  const Decoder& decoder() const { return decode_; }
  /// Height above `first()` as known so far; NaN for a gap.
  float take(double raw) {
    TerrainReport& report = map_.report;
    const double height = decode_(raw);
    if (std::isnan(height) && !decode_.is_nodata(raw) && report.unmarked++ == 0)
      report.unmarked_value = raw;
    // The first height stands for the offset until the mean is known.
    if (!std::isnan(height) && known_++ == 0) first_ = std::floor(height);
    if (!std::isnan(height)) {
      sum_ += height - first_;
      in_units_.look(height);
      in_metres_.look(height);
    }
    return static_cast<float>(height - first_);
  }
  double first() const { return first_; }
  /// Returns a whole number of metres near the mean of the values that `take` received, exact in
  /// float. Reports a staircase. @throws InputError without a height.
  double shift() const {
    if (known_ == 0)
      map_.fail("at", "", "all cells under the site are nodata",
                "move the site to where the map has data");
    if (in_metres_.found())
      note_staircase(map_, "metre", 1);
    else if (in_units_.found())
      note_staircase(map_, map_.report.height_unit, map_.report.height_metres);
    return std::floor(sum_ / static_cast<double>(known_));
  }

 private:
  MapFile& map_;
  Decoder decode_;
  Staircase in_units_, in_metres_;  ///< the latter also of metres that somebody turned into feet
  double first_ = 0, sum_ = 0;
  std::int64_t known_ = 0;
};

/// Counts the map cells at least partly on the site, and those without a height.
class SiteCells {
 public:
  SiteCells(const HeightRaster& frame, const Vec2& size, TerrainReport& report)
      : x_(range(frame.x0, frame.cell_x, size.x(), frame.nx)),
        y_(range(frame.y0, frame.cell_y, size.y(), frame.ny)),
        report_(report) {
    report.site_cells = static_cast<std::int64_t>(x_.second - x_.first) * (y_.second - y_.first);
  }
  /// Records a cell without a height.
  void gap(int ix, int iy) {
    if (ix >= x_.first && ix < x_.second && iy >= y_.first && iy < y_.second) ++report_.site_gaps;
  }

 private:
  /// Returns the first cell along an axis that touches [0, length], and the one after the last.
  static std::pair<int, int> range(double first, double cell, double length, int count) {
    const auto touches = [&](int i) {
      const double centre = first + i * cell;
      return centre + (0.5 - 1e-6) * cell > 0 && centre - (0.5 - 1e-6) * cell < length;
    };
    int begin = 0, end = count;
    while (begin < end && !touches(begin)) ++begin;
    while (end > begin && !touches(end - 1)) --end;
    return {begin, end};
  }
  std::pair<int, int> x_, y_;
  TerrainReport& report_;
};

/// Calls `work`, and names the row of a map that cannot be read.
template <class Work>
void with_rows_named(const MapFile& map, const Work& work) {
  try {
    work();
  } catch (const RowError& failure) {
    map.fail("row " + std::to_string(failure.row()), "", failure.what(),
             "the file is damaged: get it again");
  } catch (const FileError& failure) {
    map.fail("", "", failure.what(), "check the path");
  }
}

/// A map that stays open and reads cells as heights on demand.
class OpenMap {
 public:
  /// Takes ownership of the open file.
  OpenMap(MapFile& map, const Cut& cut, const Decoder& decode, double first, double shift)
      : name_(map.name),
        source_(std::move(map.source)),
        cut_(cut),
        decode_(decode),
        first_(first),
        shift_(shift) {}

  /// Reads heights as read_heights does. @throws InputError.
  void read(const CellRect& cells, float* out) {
    try {
      read_raw(*source_, cut_, cells, raw_);
    } catch (const FileError& failure) {
      name_.fail("", "", failure.what(), "the file is damaged or gone: get it again");
    }
    // Rounded to float before and after the shift, as in a map in memory.
    std::transform(raw_.begin(), raw_.end(), out, [&](double raw) {
      return static_cast<float>(static_cast<float>(decode_(raw) - first_) - shift_);
    });
  }

 private:
  MapName name_;
  std::unique_ptr<RasterSource> source_;
  Cut cut_;
  Decoder decode_;
  double first_, shift_;
  std::vector<double> raw_;
};

}  // namespace

std::int64_t cells_under(const MapFile& map, const Vec2& corner, const Vec2& size) {
  const Cut cut = cut_of(map, corner, size);
  return static_cast<std::int64_t>(cut.x1 - cut.x0 + 1) * (cut.y1 - cut.y0 + 1);
}

HeightRaster read_heights(MapFile& map, const Vec2& corner, const Vec2& size) {
  TerrainReport& report = map.report;
  const Cut cut = cut_of(map, corner, size);
  HeightRaster raster = frame_of(report, cut, corner);
  report.source_cells = static_cast<std::int64_t>(raster.nx) * raster.ny;
  // Checked before memory is allocated.
  if (static_cast<double>(report.source_cells) > limits::kMapCells)
    map.fail("size", std::to_string(raster.nx) + " x " + std::to_string(raster.ny) + " map cells",
             "more than " + number_text(limits::kMapCells) + " cells under the site",
             "choose a smaller --size or a coarser map");
  check_blocks(map, cut.x0, cut.x1, cut.y0, cut.y1);
  raster.z.resize(static_cast<std::size_t>(report.source_cells));
  Intake intake(map);
  SiteCells on_site(raster, size, report);
  std::vector<double> line;
  with_rows_named(map, [&] {
    map.source->prepare(in_file(cut, {0, 0, raster.nx, raster.ny}));
    for (int iy = 0; iy < raster.ny; ++iy) {
      read_raw(*map.source, cut, {0, iy, raster.nx, iy + 1}, line);
      for (int ix = 0; ix < raster.nx; ++ix)
        if (std::isnan(raster.at(ix, iy) = intake.take(line[static_cast<std::size_t>(ix)])))
          on_site.gap(ix, iy);
    }
  });
  const double shift = intake.shift();
  for (float& z : raster.z) z = static_cast<float>(z - shift);
  report.height_offset = intake.first() + shift;
  return raster;
}

std::shared_ptr<const WindowedRaster> read_windows(MapFile& map, const Vec2& corner,
                                                   const Vec2& size, int side) {
  TerrainReport& report = map.report;
  const Cut cut = cut_of(map, corner, size);
  const HeightRaster frame = frame_of(report, cut, corner);
  report.source_cells = static_cast<std::int64_t>(frame.nx) * frame.ny;
  // A picture is decoded from its beginning for every window.
  if (map.header.kind == RasterHeader::Kind::kPicture)
    map.fail("size", std::to_string(frame.nx) + " x " + std::to_string(frame.ny) + " map cells",
             "more than " + number_text(limits::kMapCells) + " cells of a picture under the site",
             "convert it with gdal_translate -of GTiff -co TILED=YES");
  check_blocks(map, cut.x0, cut.x1, cut.y0, cut.y1);
  with_rows_named(map, [&] { map.source->prepare(in_file(cut, {0, 0, frame.nx, frame.ny})); });
  // One pass finds the mean and the gaps; cells are read again when they are needed.
  Intake intake(map);
  SiteCells on_site(frame, size, report);
  std::vector<std::int64_t> gaps;
  std::vector<double> raw;
  for (int y0 = 0; y0 < frame.ny; y0 += side) {
    const CellRect strip{0, y0, frame.nx, std::min(y0 + side, frame.ny)};
    with_rows_named(map, [&] { read_raw(*map.source, cut, strip, raw); });
    const std::int64_t begin = static_cast<std::int64_t>(y0) * frame.nx;
    for (std::size_t i = 0; i < raw.size(); ++i)
      if (std::isnan(intake.take(raw[i]))) {
        gaps.push_back(begin + static_cast<std::int64_t>(i));
        on_site.gap(static_cast<int>(i) % frame.nx, y0 + static_cast<int>(i) / frame.nx);
      }
    if (static_cast<double>(gaps.size()) > limits::kMapCells)
      map.fail(
          "nodata", std::to_string(gaps.size()) + " cells",
          "more than " + number_text(limits::kMapCells) + " cells without a height under the site",
          "choose a smaller --size, or fill them with gdal_fillnodata.py");
  }
  const double shift = intake.shift();
  report.height_offset = intake.first() + shift;
  const auto open_map =
      std::make_shared<OpenMap>(map, cut, intake.decoder(), intake.first(), shift);
  const auto out = std::make_shared<WindowedRaster>(
      frame, [open_map](const CellRect& cells, float* to) { open_map->read(cells, to); }, side);
  report.nodata = out->fill_gaps(std::move(gaps));
  return out;
}

}  // namespace navvy::heightfield
