// SPDX-License-Identifier: Apache-2.0
// PNG files as maps, through libpng: gray values as they are in the file, without gamma or colours.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "core/limits.h"
#include "heightfield/map_files/map_file.h"
#include "heightfield/map_files/plain_rasters.h"
#include "heightfield/map_files/side_files.h"

#ifdef NAVVY_WITH_PNG
#include <png.h>
#endif

namespace navvy::heightfield {

bool is_png_file(const std::string& path) {
  static constexpr char kSignature[] = "\x89PNG\r\n\x1a\n";
  char head[8] = {};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  return file && std::fread(head, 1, sizeof head, file.get()) == sizeof head &&
         std::memcmp(head, kSignature, sizeof head) == 0;
}

#ifdef NAVVY_WITH_PNG
namespace {

/// A PNG file that libpng reads. libpng jumps out of its functions on errors, so no function that
/// it may leave has an object with a destructor.
class PngReader {
 public:
  explicit PngReader(const std::string& path)
      : file_(std::fopen(path.c_str(), "rb"), std::fclose),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning)),
        info_(png_ != nullptr ? png_create_info_struct(png_) : nullptr) {}
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Reads the header; returns false on an error.
  bool open() {
    if (!file_ || png_ == nullptr || info_ == nullptr) return false;
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_init_io(png_, file_.get());
    png_read_info(png_, info_);
    return true;
  }
  /// Decodes the rows up to the last of `cells` and writes the first channel of the cells to `out`.
  /// `line` has the size of a row, `picture` the sizes of all rows if the file is interlaced.
  /// Returns false on an error, with `row()` the one that failed.
  bool decode(const CellRect& cells, png_byte* line, png_byte* picture, std::uint16_t* out) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    // Passes of an interlaced picture each fill a part of its cells.
    for (int pass = 0; pass < passes_; ++pass)
      for (row_ = 0; row_ < (picture != nullptr ? rows() : cells.y1); ++row_) {
        png_byte* const to =
            picture != nullptr ? picture + row_bytes() * static_cast<std::size_t>(row_) : line;
        png_read_row(png_, to, nullptr);
        if (row_ >= cells.y0 && row_ < cells.y1 && pass + 1 == passes_) copy(cells, to, out);
      }
    return true;
  }
  /// Chooses the form of decoded rows; must be called once, before `decode`.
  bool begin_rows() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    // Values of fewer than 8 bits become bytes, unscaled.
    png_set_packing(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  int columns() const { return static_cast<int>(png_get_image_width(png_, info_)); }
  int rows() const { return static_cast<int>(png_get_image_height(png_, info_)); }
  int channels() const { return png_get_channels(png_, info_); }
  int depth() const { return png_get_bit_depth(png_, info_); }
  bool has_palette() const { return png_get_color_type(png_, info_) == PNG_COLOR_TYPE_PALETTE; }
  bool interlaced() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }
  std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
  /// Returns the gray value that the file declares transparent, which means "no height".
  std::optional<double> transparent() const {
    png_color_16* gray = nullptr;
    png_bytep alpha = nullptr;
    int count = 0;
    if (png_get_color_type(png_, info_) != PNG_COLOR_TYPE_GRAY ||
        png_get_tRNS(png_, info_, &alpha, &count, &gray) == 0 || gray == nullptr)
      return std::nullopt;
    return static_cast<double>(gray->gray);
  }
  int row() const { return row_; }
  std::string cause() const { return std::string("libpng: ") + cause_; }

 private:
  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(self->cause_, message, sizeof self->cause_ - 1);
    longjmp(png_jmpbuf(png), 1);
  }
  /// Warnings concern files that are read all the same.
  static void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}

  void copy(const CellRect& cells, const png_byte* line, std::uint16_t* out) const {
    const std::size_t bytes = depth() > 8 ? 2 : 1,
                      step = bytes * static_cast<std::size_t>(channels());
    out +=
        static_cast<std::size_t>(row_ - cells.y0) * static_cast<std::size_t>(cells.x1 - cells.x0);
    for (int column = cells.x0; column < cells.x1; ++column) {
      const png_byte* const at = line + step * static_cast<std::size_t>(column);
      // The high byte comes first.
      *out++ = static_cast<std::uint16_t>(bytes == 2 ? at[0] << 8 | at[1] : at[0]);
    }
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  png_structp png_;
  png_infop info_;
  int passes_ = 1, row_ = 0;
  char cause_[200] = "cannot be read";
};

/// The gray values of the cells that are wanted, decoded once: a picture is readable from its
/// beginning only.
class PngSource final : public RasterSource {
 public:
  explicit PngSource(MapName name) : name_(std::move(name)) {}

  void prepare(const CellRect& cells) override {
    held_ = cells;
    PngReader png(name_.file);
    if (!png.open() || !png.begin_rows()) throw RowError(0, png.cause());
    if (cells.x1 > png.columns() || cells.y1 > png.rows())
      throw RowError(0, "the file changed while it was read");
    check_size(png, cells);
    std::vector<png_byte> line(png.row_bytes());
    std::vector<png_byte> picture(
        png.interlaced() ? png.row_bytes() * static_cast<std::size_t>(png.rows()) : 0);
    values_.resize(static_cast<std::size_t>(cells.area()));
    if (!png.decode(cells, line.data(), png.interlaced() ? picture.data() : nullptr,
                    values_.data()))
      throw RowError(png.row(), png.cause());
  }

  void read(const CellRect& cells, double* out) override {
    for (int row = cells.y0; row < cells.y1; ++row) {
      const auto begin = values_.begin() +
                         static_cast<std::ptrdiff_t>(row - held_.y0) * (held_.x1 - held_.x0) +
                         (cells.x0 - held_.x0);
      out = std::copy(begin, begin + (cells.x1 - cells.x0), out);
    }
  }

 private:
  /// All rows before the last one needed are decoded, and an interlaced picture is held.
  void check_size(const PngReader& png, const CellRect& cells) const {
    const double most = png.interlaced() ? limits::kMapBlockBytes : limits::kMapDecodedBytes,
                 bytes = static_cast<double>(png.row_bytes()) *
                         (png.interlaced() ? png.rows() : cells.y1);
    if (bytes > most)
      name_.fail("", std::to_string(png.columns()) + " x " + std::to_string(png.rows()),
                 "more than " + number_text(most) + " bytes to decode for this site",
                 "cut the site out of it: gdal_translate -srcwin X Y COLUMNS ROWS IN OUT.png");
  }

  MapName name_;
  CellRect held_;
  std::vector<std::uint16_t> values_;
};

}  // namespace

std::unique_ptr<RasterSource> png_numbers(const MapName& name) {
  return std::make_unique<PngSource>(name);
}

OpenRaster open_png(const MapName& name) {
  OpenRaster out;
  RasterHeader& header = out.header;
  PngReader png(name.file);
  if (!png.open()) name.fail("", "", png.cause(), "the file is damaged: get it again");
  header.kind = RasterHeader::Kind::kPicture;
  header.format = "Portable Network Graphics";
  header.columns = png.columns();
  header.rows = png.rows();
  header.bands = png.channels();
  header.has_palette = png.has_palette();
  header.has_bytes = png.depth() <= 8;
  header.nodata = png.transparent();
  header.block_x = header.columns;
  header.block_bytes = 8.0 * header.columns * header.bands;
  read_world_file(name, header);
  read_auxiliary(name, header);
  out.source = png_numbers(name);
  return out;
}
#else
std::unique_ptr<RasterSource> png_numbers(const MapName& name) { return open_png(name).source; }

OpenRaster open_png(const MapName& name) {
  name.fail("", "", "this build has no libpng to read a PNG",
            "build with libpng, or convert the map: gdal_translate -of AAIGrid IN OUT.asc");
}
#endif

}  // namespace navvy::heightfield
