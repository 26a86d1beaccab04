// SPDX-License-Identifier: Apache-2.0
// Pictures in memory and on disk.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace navvy::render {

/// 8-bit sRGB picture, three bytes per pixel, top row first, rows without padding, as in a PNG.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  /// Returns the three bytes of a pixel; (0, 0) is the upper left. Does not check bounds.
  const std::uint8_t* pixel(int x, int y) const {
    // Multiplied as std::size_t, as large pictures leave the range of an int.
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
};

/// Distance along the camera's axis [m], top row first; infinity where nothing was drawn. The
/// distance is along the axis and not along the ray, so a wall parallel to the picture has one
/// depth.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> depth;

  /// Returns the distance at a pixel, counted as in Image.
  float at(int x, int y) const {
    return depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

/// Encodes `image` as PNG, optimised for speed rather than size. @throws Error when the image is
/// empty or inconsistent.
std::vector<char> encode_png(const Image& image);
/// Writes `path` atomically: the old or the new file, never a part. @throws FileError naming path
/// and cause (disk full).
void write_png(const std::string& path, const Image& image);
/// Reads any kind of PNG and converts it to three bytes per pixel. @throws FileError when missing,
/// Error when it is not a readable PNG.
Image read_png(const std::string& path);

}  // namespace navvy::render
