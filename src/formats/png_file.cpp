// SPDX-License-Identifier: Apache-2.0
// Uses libpng's simplified interface on whole pictures.
#include "formats/png_file.h"

#include <png.h>

#include <string>

#include "core/error.h"

namespace navvy::formats {

std::vector<char> png_bytes(PixelKind kind, int width, int height,
                            const std::vector<std::uint8_t>& pixels) {
  if (width <= 0 || height <= 0 ||
      pixels.size() != static_cast<std::size_t>(kind) * static_cast<std::size_t>(width) *
                           static_cast<std::size_t>(height))
    throw Error("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels with " + std::to_string(pixels.size()) + " bytes cannot become a PNG");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(width);
  png.height = static_cast<png_uint_32>(height);
  png.format = kind == PixelKind::kGrayAlpha ? PNG_FORMAT_GA : PNG_FORMAT_RGBA;
  // libpng gives an upper bound for any content, so that one call suffices.
  std::vector<char> out(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = out.size();
  if (png_image_write_to_memory(&png, out.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw Error(std::string("libpng cannot encode the picture: ") + png.message);
  out.resize(size);
  return out;
}

}  // namespace navvy::formats
