// SPDX-License-Identifier: Apache-2.0
// ESRI ASCII grids without GDAL: one pass checks the words and finds the rows, which are parsed
// when they are read.
#include <cmath>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "heightfield/map_files/ascii_words.h"
#include "heightfield/map_files/plain_rasters.h"
#include "heightfield/map_files/side_files.h"

namespace navvy::heightfield {
namespace {

/// GDAL refuses grids with more columns or rows, too.
constexpr double kMostSide = 1e7;

/// Rows of an ESRI ASCII grid, by their positions in the file.
class AsciiSource final : public RasterSource {
 public:
  AsciiSource(std::string path, int columns) : path_(std::move(path)), columns_(columns) {}

  void prepare(const CellRect& cells) override {
    first_ = cells.y0;
    rows_.reserve(static_cast<std::size_t>(cells.y1 - cells.y0));
    const auto keep = [&](std::int64_t index, std::int64_t position) {
      if (index % columns_ == 0 && index / columns_ >= first_) rows_.push_back(position);
    };
    const std::int64_t wanted = static_cast<std::int64_t>(cells.y1) * columns_;
    const std::int64_t found = check_words(path_, wanted, keep);
    if (found < wanted)
      throw RowError(static_cast<int>(found / columns_),
                     "the file ends after " + std::to_string(found % columns_) + " of its " +
                         std::to_string(columns_) + " numbers");
    words_ = std::make_unique<TextWords>(path_);
  }

  void read(const CellRect& cells, double* out) override {
    std::string_view word;
    std::int64_t line = 0;
    for (int row = cells.y0; row < cells.y1; ++row) {
      words_->seek(rows_[static_cast<std::size_t>(row - first_)]);
      for (int column = 0; column < cells.x1; ++column) {
        if (!words_->next(word, line)) throw RowError(row, "the file became shorter");
        if (column < cells.x0) continue;
        const std::optional<double> value = map_number(word);
        if (!value) throw RowError(row, "the file changed while it was read");
        *out++ = *value;
      }
    }
  }

 private:
  std::string path_;
  int columns_;
  /// Row of the first entry of `rows_`, which are positions in the file.
  int first_ = 0;
  std::vector<std::int64_t> rows_;
  std::unique_ptr<TextWords> words_;
};

using Keys = std::map<std::string, double>;

int side_of(const MapName& name, const Keys& keys, const std::string& key) {
  const auto found = keys.find(key);
  const std::string remedy =
      "give the file a header of ncols, nrows, xllcorner, yllcorner and cellsize";
  if (found == keys.end()) name.fail(key, "", "the header does not give it", remedy);
  const double value = found->second;
  if (!(value >= 1) || value > kMostSide || value != std::floor(value))
    name.fail(key, std::to_string(value), "must be a whole number from 1 to 10 million", remedy);
  return static_cast<int>(value);
}

/// Finds the georeference; corners that only one axis has count for nothing, as in GDAL.
void place(const MapName& name, const Keys& keys, RasterHeader& header) {
  const auto has = [&](const char* key) { return keys.count(key) != 0; };
  const bool square = has("cellsize");
  if (!square && !(has("dx") && has("dy")))
    name.fail("cellsize", "", "the header does not give it",
              "add the edge of a cell, or dx and dy");
  const double dx = keys.at(square ? "cellsize" : "dx"), dy = keys.at(square ? "cellsize" : "dy");
  double left = 0, top = 0;
  if (has("xllcorner") && has("yllcorner")) {
    left = keys.at("xllcorner");
    top = keys.at("yllcorner") + header.rows * dy;
  } else if (has("xllcenter") && has("yllcenter")) {
    header.point_registered = true;
    left = keys.at("xllcenter") - 0.5 * dx;
    top = keys.at("yllcenter") - 0.5 * dy + header.rows * dy;
  }
  header.place = {{left, dx, 0, top, 0, -dy}};
}

}  // namespace

bool is_ascii_grid(const std::string& path) {
  char head[9] = {};
  std::ifstream(path, std::ios::binary).read(head, sizeof head);
  const std::string begin = lower_case(std::string_view(head, sizeof head));
  for (const char* key : {"ncols", "nrows", "xllcorner", "yllcorner", "xllcenter", "yllcenter",
                          "dx", "dy", "cellsize"})
    if (begin.rfind(key, 0) == 0) return true;
  return false;
}

std::unique_ptr<RasterSource> ascii_numbers(const MapName& name, int columns) {
  return std::make_unique<AsciiSource>(name.file, columns);
}

OpenRaster open_ascii_grid(const MapName& name) {
  OpenRaster out;
  RasterHeader& header = out.header;
  Keys keys;
  try {
    TextWords words(name.file);
    std::string_view word;
    std::int64_t line = 0;
    // The first of several equal keys counts.
    read_ascii_header(name.file, words, word, line,
                      [&](const std::string& key, double value) { keys.emplace(key, value); });
  } catch (const FileError& failure) {
    name.fail("", "", failure.what(), "check the path");
  }
  header.kind = RasterHeader::Kind::kAsciiGrid;
  header.format = "Arc/Info ASCII Grid";
  header.columns = side_of(name, keys, "ncols");
  header.rows = side_of(name, keys, "nrows");
  place(name, keys, header);
  if (const auto found = keys.find("nodata_value"); found != keys.end())
    header.nodata = found->second;
  // Rows are read one by one, as doubles.
  header.block_x = header.columns;
  header.block_bytes = 8.0 * header.columns;
  read_projection(name, header);
  read_auxiliary(name, header);
  out.source = ascii_numbers(name, header.columns);
  return out;
}

}  // namespace navvy::heightfield
