// SPDX-License-Identifier: Apache-2.0
// Pictures in memory and on disk.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::render {

/// 8-bit sRGB, three bytes a pixel, top row first. Rows have no padding: what a PNG holds and what
/// other tools expect.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  /// The three bytes of one pixel; (0, 0) is the upper left. Nothing is checked.
  const std::uint8_t* pixel(int x, int y) const {
    // Multiplied as std::size_t, as large pictures leave the range of an int.
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
};

/// Distance along the camera's axis [m], top row first; infinity where nothing was drawn. The
/// distance is along the axis and not along the ray, so a wall across the picture has one depth.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> depth;

  /// Distance at one pixel, counted as in Image.
  float at(int x, int y) const {
    return depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

/// PNG of `image` as bytes, made for speed and not for size. @throws Error when the image is empty
/// or inconsistent.
std::vector<char> encode_png(const Image& image);
/// Writes `path` atomically (old or new, never half). @throws FileError naming path and cause (disk
/// full).
void write_png(const std::string& path, const Image& image);
/// Any kind of PNG is turned into three bytes a pixel.
/// @throws FileError when missing, Error when it is no readable PNG.
Image read_png(const std::string& path);

}  // namespace navvy::render
