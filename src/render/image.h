// SPDX-License-Identifier: Apache-2.0
// Colour and depth pictures, in memory and as PNG files.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace navvy::render {

/// A picture in 8-bit sRGB. As in a PNG file, rows are stored from top to bottom.
struct Image {
  /// Size [pixels].
  int width = 0, height = 0;
  /// Colours, three bytes (red, green, blue) per pixel, rows without padding.
  std::vector<std::uint8_t> rgb;

  /// Returns a pointer to the three bytes of a pixel. Pixel (0, 0) is the upper left one. Bounds
  /// are not checked.
  const std::uint8_t* pixel(int x, int y) const {
    // Multiplied as std::size_t, as large pictures leave the range of an int.
    return rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(x));
  }
};

/// Depth picture of a camera.
///
/// The depth of a pixel is the distance measured along the camera's axis, not along the ray through
/// the pixel, so a wall parallel to the picture has the same depth everywhere.
struct DepthImage {
  /// Size [pixels].
  int width = 0, height = 0;
  /// Depths [m], one per pixel, rows from top to bottom; infinity where nothing was drawn.
  std::vector<float> depth;

  /// Returns the depth of a pixel [m]. Pixel (0, 0) is the upper left one. Bounds are not checked.
  float at(int x, int y) const {
    return depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

/// Returns the content of a PNG file with the picture, compressed for speed rather than size.
/// @throws Error if the picture is empty, or if its size does not match its data.
std::vector<char> encode_png(const Image& image);
/// Returns the content of a grey PNG file of 16 bits with `width` x `height` values, rows from top
/// to bottom. Readers get back the same values.
/// @throws Error if the picture is empty, or if its size does not match its data.
std::vector<char> encode_png(int width, int height, std::span<const std::uint16_t> values);
/// Writes a picture to the PNG file `path`. The file is replaced as a whole: a reader sees either
/// the old or the new content. @throws FileError with path and cause if writing fails.
void write_png(const std::string& path, const Image& image);
/// Reads a PNG file of any colour type and converts it to three bytes per pixel. @throws FileError
/// if the file cannot be opened, Error if its content is not a valid PNG.
Image read_png(const std::string& path);

}  // namespace navvy::render
