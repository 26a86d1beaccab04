// SPDX-License-Identifier: Apache-2.0
#include "geometry/topology.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace navvy::geometry {
namespace {

/// Connected pieces of vertices: a forest whose roots identify the pieces.
class Pieces {
 public:
  explicit Pieces(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(int vertex) {
    auto i = static_cast<std::size_t>(vertex);
    // Path halving keeps later look-ups short.
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// Returns the pieces; triangles that share a vertex belong to one piece.
Pieces pieces_of(const TriangleMesh& mesh) {
  Pieces pieces(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[1], t[2]);
  }
  return pieces;
}

/// Number of times that an edge is traversed from its lower to its higher vertex, and back.
struct Runs {
  int up = 0, down = 0;
};

/// Counts the traversals by the edge's lower and higher vertex. The map is sorted, so the first
/// clash does not depend on hashing.
std::map<std::pair<int, int>, Runs> runs_of(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, Runs> runs;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      Runs& edge = runs[std::minmax(a, b)];
      ++(a < b ? edge.up : edge.down);
    }
  return runs;
}

}  // namespace

std::optional<WindingClash> find_winding_clash(const TriangleMesh& mesh) {
  // A directed edge belongs to one triangle of a consistently wound surface.
  std::map<std::pair<int, int>, std::size_t> used;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& t = mesh.triangles[n];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [at, is_new] = used.insert({{t[i], t[(i + 1) % 3]}, n});
      if (!is_new) return WindingClash{at->second, n};
    }
  }
  return std::nullopt;
}

bool is_solid(const TriangleMesh& loose) {
  const TriangleMesh mesh = welded(loose);
  // More than two triangles may meet at an edge where bodies touch; both directions must balance
  // there too.
  for (const auto& [edge, runs] : runs_of(mesh))
    if (edge.first != edge.second && runs.up != runs.down) return false;
  Pieces pieces = pieces_of(mesh);
  // Six times the volume between the triangles of a piece and the origin. Summed per piece, so that
  // a piece turned inwards is not hidden by a larger one.
  std::map<std::size_t, double> volume;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    volume[pieces.find(mesh.triangles[t][0])] +=
        mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2)));
  return std::all_of(volume.begin(), volume.end(),
                     [](const auto& piece) { return piece.second > 0; });
}

}  // namespace navvy::geometry
