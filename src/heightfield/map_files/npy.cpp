// SPDX-License-Identifier: Apache-2.0
// The header is a Python dictionary as text: its three keys are found by name, and nothing is
// evaluated.
#include "heightfield/map_files/npy.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "core/limits.h"

namespace navvy::heightfield {
namespace {

// From the format's description in numpy.lib.format: magic, version of two bytes, length of the
// header (2 bytes in version 1, 4 in versions 2 and 3), header, numbers.
constexpr char kMagic[] = "\x93NUMPY";
constexpr std::size_t kMagicBytes = 6;
/// NumPy itself writes 128 bytes; a table of fields, which no map is, may be longer.
constexpr std::size_t kMostHeader = 4096;
constexpr int kMostSide = 1 << 30;

struct TypeRow {
  const char* name;
  NpyType type;
  std::size_t bytes;
};
constexpr std::array<TypeRow, 6> kTypes = {{{"<f4", NpyType::kFloat32, 4},
                                            {"<f8", NpyType::kFloat64, 8},
                                            {"<i2", NpyType::kInt16, 2},
                                            {"<i4", NpyType::kInt32, 4},
                                            {"<u2", NpyType::kUint16, 2},
                                            {"|u1", NpyType::kUint8, 1}}};

/// Parses a header; faults name the file and the place in it.
struct Header {
  std::string path;
  std::string text;
  /// Position of the header's text in the file.
  std::size_t at = 0;

  [[noreturn]] void fail(const std::string& key, const std::string& value, const std::string& rule,
                         const std::string& remedy) const {
    throw InputError(Fault{Fault::Severity::kError, path, 0, "npy " + key, value, rule, remedy});
  }
  /// Returns the text after 'key', without blanks, up to the end of the header.
  std::string after(const std::string& key) const {
    // NumPy sorts the keys, but the format leaves their order free.
    const std::size_t found = text.find("'" + key + "'");
    std::size_t from =
        found == std::string::npos ? found : text.find_first_not_of(' ', found + key.size() + 2);
    if (from == std::string::npos || text[from] != ':')
      fail("byte " + std::to_string(at), text.substr(0, 60), "the header has no '" + key + "'",
           "write the file with numpy.save");
    from = text.find_first_not_of(' ', from + 1);
    return from == std::string::npos ? "" : text.substr(from);
  }
};

// Only little-endian types of one number are maps.
const TypeRow& type_of(const Header& header) {
  const std::string value = header.after("descr");
  for (const TypeRow& row : kTypes)
    if (value.rfind("'" + std::string(row.name) + "'", 0) == 0) return row;
  header.fail(
      "descr", value.substr(0, value.find(',')),
      "heights are '<f4', '<f8', '<i2', '<i4', '<u2' or '|u1': one little-endian number a cell",
      "numpy.save(PATH, array.astype('<f4'))");
}

/// Parses the two lengths of "(7, 13), ...".
void read_shape(const Header& header, NpyGrid& grid) {
  const std::string value = header.after("shape");
  const std::string found =
      value.substr(0, value.find(')') == std::string::npos ? 40 : value.find(')') + 1);
  std::array<int, 2> sides = {};
  const char* p = value.data();
  const char* end = p + value.size();
  bool sound = p != end && *p++ == '(';
  for (int i = 0; i < 2 && sound; ++i) {
    // The comma of "(7,)" is followed by no number, so an array of one axis is refused here.
    while (p != end && (*p == ' ' || (i == 1 && *p == ','))) ++p;
    const auto [next, failed] = std::from_chars(p, end, sides[static_cast<std::size_t>(i)]);
    sound = failed == std::errc() && sides[static_cast<std::size_t>(i)] > 0 &&
            sides[static_cast<std::size_t>(i)] <= kMostSide;
    p = next;
  }
  while (sound && p != end && (*p == ' ' || *p == ',')) ++p;
  if (!sound || p == end || *p != ')')
    header.fail("shape", found, "a map has two axes, rows and columns, none of them empty",
                "save one map: numpy.save(PATH, array[..., 0])");
  grid.rows = sides[0];
  grid.columns = sides[1];
}

/// Removes magic, version and header from the front of `bytes`.
Header take_header(const std::string& path, std::vector<char>& bytes) {
  Header header{path, "", 0};
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
  };
  const bool long_length =
      bytes.size() > kMagicBytes && (bytes[kMagicBytes] == 2 || bytes[kMagicBytes] == 3);
  header.at = kMagicBytes + 2 + (long_length ? 4 : 2);
  if (bytes.size() < header.at || std::memcmp(bytes.data(), kMagic, kMagicBytes) != 0 ||
      (!long_length && bytes[kMagicBytes] != 1))
    header.fail("byte 0", "", "is not an NPY file of version 1 to 3",
                "write the file with numpy.save");
  // Both lengths are little-endian.
  std::size_t length = byte(8) + 256 * byte(9);
  if (long_length) length += (byte(10) << 16) + (byte(11) << 24);
  if (length > kMostHeader || header.at + length > bytes.size())
    header.fail("byte 8", std::to_string(length),
                "is longer than the file, or than any map's header",
                "the file is damaged: save it again");
  header.text.assign(bytes.data() + header.at, length);
  bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.at + length));
  return header;
}

}  // namespace

// Decides by content and not by the ending of the name.
bool is_npy_file(const std::string& path) {
  char head[kMagicBytes] = {};
  // A file that cannot be read leaves `head` empty; whoever opens it next reports the cause.
  std::ifstream(path, std::ios::binary).read(head, sizeof head);
  return std::memcmp(head, kMagic, kMagicBytes) == 0;
}

// The size is checked against the header before the numbers are used.
NpyGrid read_npy(const std::string& path) {
  NpyGrid grid;
  try {
    grid.bytes = read_file(path, limits::kNpyBytes);
  } catch (const FileError& failure) {
    throw InputError(Fault{Fault::Severity::kError, path, 0, "npy", "", failure.what(),
                           "larger maps as GeoTIFF, of which only what is needed is read"});
  }
  const Header header = take_header(path, grid.bytes);
  const TypeRow& type = type_of(header);
  grid.type = type.type;
  const std::string order = header.after("fortran_order");
  if (order.rfind("False", 0) != 0)
    header.fail("fortran_order", order.substr(0, order.find(',')),
                "rows must follow each other (C order)",
                "numpy.save(PATH, numpy.ascontiguousarray(array))");
  read_shape(header, grid);
  // Computed in double, because the product of the numbers of a damaged header may not fit an
  // integer.
  const double wanted =
      static_cast<double>(grid.rows) * grid.columns * static_cast<double>(type.bytes);
  if (wanted != static_cast<double>(grid.bytes.size()))
    header.fail("byte " + std::to_string(header.at + header.text.size()),
                std::to_string(grid.bytes.size()) + " bytes",
                std::to_string(grid.rows) + " x " + std::to_string(grid.columns) + " numbers of " +
                    std::to_string(type.bytes) + " bytes have to follow the header",
                "the file is cut or damaged: save it again");
  return grid;
}

}  // namespace navvy::heightfield
