// SPDX-License-Identifier: Apache-2.0
#include "geometry/topology.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace navvy::geometry {
namespace {

/// Connected pieces of vertex numbers: a forest whose roots name the pieces.
class Pieces {
 public:
  explicit Pieces(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(int vertex) {
    auto i = static_cast<std::size_t>(vertex);
    // Halving the way up at each look keeps later looks short.
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

/// Triangles that share a vertex belong together, whether they share an edge or not.
Pieces pieces_of(const TriangleMesh& mesh) {
  Pieces pieces(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    pieces.join(t[0], t[1]);
    pieces.join(t[1], t[2]);
  }
  return pieces;
}

/// How often an edge is run through from its lower to its higher vertex, and back.
struct Runs {
  int up = 0, down = 0;
};

/// By the edge's lower and higher vertex. A sorted map: what is found first does not depend on
/// hashing.
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

MeshReport inspect(const TriangleMesh& mesh) {
  require_valid(mesh, "mesh");
  MeshReport report;
  for (const auto& [edge, runs] : runs_of(mesh)) {
    if (edge.first == edge.second) continue;  // a corner named twice; told as a flat triangle
    report.free_edges += runs.up + runs.down == 1;
    report.crowded_edges += runs.up + runs.down > 2;
    // Fronts agree where one triangle goes up the edge and the other down.
    report.clashing_edges += runs.up > 1 || runs.down > 1;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    report.flat_triangles += !(mesh.area_vector(t).norm() > 0);
  Pieces pieces = pieces_of(mesh);
  // Roots of triangles only: a loose vertex is a root of its own.
  std::set<std::size_t> roots;
  for (const auto& t : mesh.triangles) roots.insert(pieces.find(t[0]));
  report.pieces = static_cast<int>(roots.size());
  return report;
}

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
  // More than two triangles may meet at an edge where bodies touch; up and down must balance there
  // too.
  for (const auto& [edge, runs] : runs_of(mesh))
    if (edge.first != edge.second && runs.up != runs.down) return false;
  Pieces pieces = pieces_of(mesh);
  // Six times the volume between the piece's triangles and the origin; a piece turned inwards must
  // not hide behind a larger one.
  std::map<std::size_t, double> volume;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    volume[pieces.find(mesh.triangles[t][0])] +=
        mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2)));
  return std::all_of(volume.begin(), volume.end(),
                     [](const auto& piece) { return piece.second > 0; });
}

}  // namespace navvy::geometry
