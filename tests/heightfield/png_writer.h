// SPDX-License-Identifier: Apache-2.0
// Writes PNG files of any kind for tests.
#pragma once

#include <png.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

namespace navvy::heightfield::testing {

/// Kind of a PNG file.
struct PngKind {
  int depth = 16;
  int color = PNG_COLOR_TYPE_GRAY;
  bool interlaced = false;
  /// Gray value that is transparent; -1: none.
  int transparent = -1;
};

/// Writes a picture; `gray(column, row)` is the first channel, further ones are at their maximum.
inline std::string write_png(const std::string& path, int columns, int rows, const PngKind& kind,
                             const std::function<int(int, int)>& gray) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows),
               kind.depth, kind.color, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (kind.color == PNG_COLOR_TYPE_PALETTE) {
    const std::vector<png_color> palette(256, png_color{1, 2, 3});
    png_set_PLTE(png, info, palette.data(), 256);
  }
  if (kind.transparent >= 0) {
    png_color_16 value{};
    value.gray = static_cast<png_uint_16>(kind.transparent);
    png_set_tRNS(png, info, nullptr, 0, &value);
  }
  png_write_info(png, info);
  // One byte for each value of fewer bits.
  png_set_packing(png);
  const int channels = png_get_channels(png, info), bytes = kind.depth > 8 ? 2 : 1;
  std::vector<std::vector<png_byte>> lines;
  std::vector<png_bytep> pointers;
  pointers.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    std::vector<png_byte> line(static_cast<std::size_t>(columns * channels * bytes), 255);
    for (int column = 0; column < columns; ++column) {
      png_byte* at = line.data() + column * channels * bytes;
      const int value = gray(column, row);
      if (bytes == 2) *at++ = static_cast<png_byte>(value >> 8);
      *at = static_cast<png_byte>(value);
    }
    lines.push_back(std::move(line));
  }
  for (std::vector<png_byte>& line : lines) pointers.push_back(line.data());
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return path;
}

}  // namespace navvy::heightfield::testing
