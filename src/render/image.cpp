// SPDX-License-Identifier: Apache-2.0
#include "render/image.h"

#include <png.h>

#include <string>

#include "core/error.h"
#include "core/file.h"

namespace navvy::render {

namespace {

/// Encodes `data` of libpng's `format`, of which there are `values` numbers, `channels` a pixel.
std::vector<char> encode(int width, int height, png_uint_32 format, std::size_t channels,
                         const void* data, std::size_t values) {
  // An image filled by a caller may be inconsistent; libpng would read beyond its end.
  if (width <= 0 || height <= 0 ||
      values != channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw Error("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels with " + std::to_string(values) + " values cannot become a PNG");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = format;
  // Larger files in a fraction of the time: a run writes pictures by the hundred.
  png.flags = PNG_IMAGE_FLAG_FAST;
  // An upper bound by libpng for any content, so that one write suffices.
  std::vector<char> out(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = out.size();
  if (png_image_write_to_memory(&png, out.data(), &size, 0, data, 0, nullptr) == 0)
    throw Error(std::string("libpng cannot encode the picture: ") + png.message);
  out.resize(size);
  return out;
}

}  // namespace

std::vector<char> encode_png(const Image& image) {
  return encode(image.width, image.height, PNG_FORMAT_RGB, 3, image.rgb.data(), image.rgb.size());
}

std::vector<char> encode_png(int width, int height, std::span<const std::uint16_t> values) {
  // libpng writes this format without converting it.
  return encode(width, height, PNG_FORMAT_LINEAR_Y, 1, values.data(), values.size());
}

void write_png(const std::string& path, const Image& image) {
  write_file_atomically(path, encode_png(image));
}

Image read_png(const std::string& path) {
  const std::vector<char> bytes = read_file(path);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    throw Error("'" + path + "' is no readable PNG: " + png.message);
  // libpng converts grey and alpha to this format.
  png.format = PNG_FORMAT_RGB;
  Image out;
  out.width = static_cast<int>(png.width);
  out.height = static_cast<int>(png.height);
  out.rgb.resize(PNG_IMAGE_SIZE(png));
  if (png_image_finish_read(&png, nullptr, out.rgb.data(), 0, nullptr) == 0)
    throw Error("'" + path + "' is no readable PNG: " + png.message);
  return out;
}

}  // namespace navvy::render
