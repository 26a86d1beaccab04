// SPDX-License-Identifier: Apache-2.0
// A folder of NumPy arrays for excavation planners like Terra: one map, number 1, of small
// integers.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>

#include "core/error.h"
#include "core/file.h"
#include "formats/formats.h"
#include "formats/npy_file.h"
#include "formats/part_folder.h"

namespace navvy::formats {
namespace {

constexpr const char* kFolders[] = {"images", "occupancy", "dumpability", "distance"};
constexpr const char* kImage = "img_1.npy";

/// Computes the least of (i - k)^2 + f[k] for each place i of a line [Felzenszwalb 2012].
void lower_envelope(const std::vector<double>& f, std::vector<double>& out) {
  const int n = static_cast<int>(f.size());
  std::vector<int> at(f.size());
  // `at` holds the parabolas of the envelope, `from` the place where each begins to be the lowest.
  std::vector<double> from(f.size() + 1);
  int count = 0;
  for (int q = 0; q < n; ++q) {
    if (!std::isfinite(f[static_cast<std::size_t>(q)])) continue;
    const auto meet = [&](int p) {
      return (f[static_cast<std::size_t>(q)] + static_cast<double>(q) * q -
              f[static_cast<std::size_t>(p)] - static_cast<double>(p) * p) /
             (2.0 * (q - p));
    };
    while (count > 0 && meet(at[static_cast<std::size_t>(count - 1)]) <=
                            from[static_cast<std::size_t>(count - 1)])
      --count;
    from[static_cast<std::size_t>(count)] = count == 0
                                                ? -std::numeric_limits<double>::infinity()
                                                : meet(at[static_cast<std::size_t>(count - 1)]);
    at[static_cast<std::size_t>(count++)] = q;
  }
  for (int i = 0, k = 0; i < n; ++i) {
    while (k + 1 < count && from[static_cast<std::size_t>(k + 1)] < i) ++k;
    const int p = count > 0 ? at[static_cast<std::size_t>(k)] : 0;
    out[static_cast<std::size_t>(i)] =
        count == 0 ? std::numeric_limits<double>::infinity()
                   : static_cast<double>(i - p) * (i - p) + f[static_cast<std::size_t>(p)];
  }
}

/// Returns the distance [m] from the centre of each column to that of the nearest marked one; -1
/// where none is marked.
std::vector<float> distances(const std::vector<std::int8_t>& marked, int nx, int ny, double cell) {
  const double far = std::numeric_limits<double>::infinity();
  std::vector<double> square(marked.size());
  for (std::size_t k = 0; k < marked.size(); ++k) square[k] = marked[k] != 0 ? 0 : far;
  // A pass along x, then one along y over its result.
  const auto pass = [&](int lines, int length, std::size_t line_step, std::size_t step) {
    std::vector<double> f(static_cast<std::size_t>(length)), out(f.size());
    for (int l = 0; l < lines; ++l) {
      const std::size_t first = static_cast<std::size_t>(l) * line_step;
      for (std::size_t i = 0; i < f.size(); ++i) f[i] = square[first + i * step];
      lower_envelope(f, out);
      for (std::size_t i = 0; i < f.size(); ++i) square[first + i * step] = out[i];
    }
  };
  const auto width = static_cast<std::size_t>(nx);
  pass(ny, nx, width, 1);
  pass(nx, ny, 1, width);
  std::vector<float> out;
  out.reserve(square.size());
  for (const double d : square)
    out.push_back(std::isfinite(d) ? static_cast<float>(cell * std::sqrt(d)) : -1.0f);
  return out;
}

std::vector<std::string> terra_files(const std::string& name) {
  // Folders of every name hold the same files.
  (void)name;
  std::vector<std::string> out;
  for (const char* folder : kFolders) out.push_back(std::string(folder) + "/" + kImage);
  return out;
}

// The arrays are computed completely before the folder is made, so that an error leaves nothing
// behind.
void write_terra(const map::TerrainMap& map, const std::vector<map::MapLayer>& layers,
                 const std::string& path) {
  for (const map::MapLayer needed :
       {map::MapLayer::kTarget, map::MapLayer::kElevation, map::MapLayer::kTraversability})
    if (!map.has(needed))
      throw InputError(Fault{Fault::Severity::kError, path, 0, "terra", map::info(needed).name,
                             "is needed but was not named", "omit --layers"});
  (void)layers;
  std::vector<std::int8_t> dig, target, occupied, dumpable;
  const std::vector<float> z = map.copy(map::MapLayer::kElevation),
                           wanted = map.copy(map::MapLayer::kTarget),
                           good = map.copy(map::MapLayer::kTraversability);
  // A deviation below a twentieth of a column edge counts as finished.
  const double least = 0.05 * map.cell();
  for (std::size_t k = 0; k < z.size(); ++k) {
    const double rise = static_cast<double>(z[k]) - static_cast<double>(wanted[k]);
    // Comparisons with an unknown height are false, so such columns are neutral.
    const std::int8_t aim = rise > least    ? std::int8_t{-1}
                            : rise < -least ? std::int8_t{1}
                                            : std::int8_t{0};
    target.push_back(aim);
    dig.push_back(aim < 0 ? 1 : 0);
    // Unknown traversability counts as occupied, since the comparison is false.
    occupied.push_back(good[k] > 0 ? 0 : 1);
    // Nothing is dumped where soil is still to be dug.
    dumpable.push_back(aim >= 0 && good[k] > 0 ? 1 : 0);
  }
  const std::vector<float> distance = distances(dig, map.nx(), map.ny(), map.cell());
  PartFolder part(path, terra_files(folder_name(path)));
  const auto write = [&](const char* folder, const auto& values) {
    const std::filesystem::path place = std::filesystem::path(part.place()) / folder;
    std::error_code failed;
    std::filesystem::create_directories(place, failed);
    if (failed) throw FileError("cannot make '" + place.string() + "': " + failed.message());
    write_file_atomically((place / kImage).string(), npy_bytes(values, map.nx(), map.ny()));
  };
  write(kFolders[0], target);
  write(kFolders[1], occupied);
  write(kFolders[2], dumpable);
  write(kFolders[3], distance);
  part.commit();
}

}  // namespace

MapFormat terra_format() {
  return {.name = "terra",
          .extension = "",
          .meaning = "folder of NumPy arrays: target -1/0/1, occupancy, dumpability, distance",
          .by_default = {map::MapLayer::kTarget, map::MapLayer::kElevation,
                         map::MapLayer::kTraversability},
          .write = write_terra,
          .within = terra_files,
          .needs_design = true};
}

}  // namespace navvy::formats
