// SPDX-License-Identifier: Apache-2.0
#include "render/solid.h"

#include <array>
#include <map>
#include <numeric>
#include <span>
#include <utility>

namespace navvy::render {
namespace {

/// Connected pieces of point numbers.
class Pieces {
 public:
  explicit Pieces(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  // With halving of paths, so that a million edges stay cheap.
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// Six times the volume between a face (as a fan) and the origin. In doubles, as volumes far from the origin are
/// differences of large numbers.
double fan_volume(const std::vector<Vec3f>& points, std::span<const std::int32_t> face) {
  const auto point = [&](std::size_t k) -> Vec3 { return points[static_cast<std::size_t>(face[k])].cast<double>(); };
  double volume = 0;
  for (std::size_t k = 2; k < face.size(); ++k) volume += point(0).dot(point(k - 1).cross(point(k)));
  return volume;
}

}  // namespace

bool is_solid(const std::vector<Vec3f>& points, const std::vector<std::int32_t>& indices) {
  // Points that were written twice, as exporters do along seams, would look like open edges.
  std::map<std::array<float, 3>, std::size_t> number;
  std::vector<std::size_t> merged;
  merged.reserve(points.size());
  for (const Vec3f& p : points)
    merged.push_back(number.try_emplace({p.x(), p.y(), p.z()}, number.size()).first->second);
  Pieces pieces(number.size());
  std::map<std::pair<std::size_t, std::size_t>, int> walks;
  std::map<std::size_t, double> volume;
  const auto for_each_face = [&](const auto& work) {
    for (std::size_t first = 0, i = 0; i < indices.size(); ++i)
      if (indices[i] < 0) {
        work(std::span(indices).subspan(first, i - first));
        first = i + 1;
      }
  };
  for_each_face([&](std::span<const std::int32_t> face) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::size_t a = merged[static_cast<std::size_t>(face[k])];
      const std::size_t b = merged[static_cast<std::size_t>(face[(k + 1) % face.size()])];
      // An edge that two faces share is walked once each way, so a closed body comes out even everywhere.
      ++walks[{a, b}];
      --walks[{b, a}];
      pieces.join(a, b);
    }
  });
  for (const auto& [edge, balance] : walks)
    if (balance != 0) return false;
  for_each_face([&](std::span<const std::int32_t> face) {
    if (!face.empty()) volume[pieces.find(merged[static_cast<std::size_t>(face[0])])] += fan_volume(points, face);
    // A body turned inside out has negative volume; its inner side would be drawn and its outer one left out.
  });
  for (const auto& [piece, size] : volume)
    if (!(size > 0)) return false;
  return true;
}

}  // namespace navvy::render
