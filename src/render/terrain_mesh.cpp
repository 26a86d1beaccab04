// SPDX-License-Identifier: Apache-2.0
// A tile is a grid of vertices at a stride of 2^level columns. The level follows from the size of a
// cell in the picture; where two levels meet, skirts hang down behind the seam instead of matching
// vertices.
#include "render/terrain_mesh.h"

namespace navvy::render {
namespace {

// Cells smaller than this show no more detail [pixels].
constexpr float kFinest = 7.0f;
// A steeper slope (58 degrees) is a wall with separate triangles.
constexpr float kWallSlope = 1.6f;

/// Returns the node coordinates along one axis of a tile at a stride, including both ends.
std::vector<int> nodes(int first, int cells, int stride) {
  std::vector<int> out;
  for (int k = 0; k < cells; k += stride) out.push_back(first + k);
  out.push_back(first + cells);
  return out;
}

Vertex colored(const Vec3f& p, const Vec3f& color) {
  return {p.x(), p.y(), p.z(), to_byte(color.x()), to_byte(color.y()), to_byte(color.z()), 255};
}

/// Averages the colour of the stride x stride columns around a node, so that coarse levels do not
/// flicker.
Vertex node_vertex(const GroundSurface& surface, int ix, int iy, int stride) {
  const Vec3f p = surface.point(ix, iy);
  if (stride == 1) {
    const auto& c = surface.lit(ix, iy);
    return {p.x(), p.y(), p.z(), c[0], c[1], c[2], 255};
  }
  const int reach = stride / 2, step = std::max(1, stride / 4);
  int sum[3] = {0, 0, 0}, n = 0;
  for (int y = std::max(0, iy - reach); y <= std::min(surface.ny() - 1, iy + reach); y += step)
    for (int x = std::max(0, ix - reach); x <= std::min(surface.nx() - 1, ix + reach);
         x += step, ++n)
      for (int k = 0; k < 3; ++k) sum[k] += surface.lit(x, y)[static_cast<std::size_t>(k)];
  const auto mean = [n](int total) { return static_cast<std::uint8_t>((total + n / 2) / n); };
  return {p.x(), p.y(), p.z(), mean(sum[0]), mean(sum[1]), mean(sum[2]), 255};
}

// Split along the diagonal a - c.
void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
}

/// Adds the two triangles of a cell as walls: separate vertices, lit by face.
void add_wall(Mesh& mesh, const GroundSurface& surface,
              const std::array<std::array<int, 2>, 4>& corner, const std::array<int, 6>& order) {
  for (std::size_t t = 0; t < 6; t += 3) {
    std::array<Vec3f, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& c = corner[static_cast<std::size_t>(order[t + k])];
      p[k] = surface.point(c[0], c[1]);
    }
    const Vec3f n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const bool wall = n.z() < 0.62f;  // The other triangle may be level.
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& c = corner[static_cast<std::size_t>(order[t + k])];
      (wall ? mesh.walls : mesh.indices)
          .push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      const auto& lit = surface.lit(c[0], c[1]);
      if (wall)
        mesh.vertices.push_back(colored(p[k], surface.wall_color(c[0], c[1], n)));
      else
        mesh.vertices.push_back({p[k].x(), p[k].y(), p[k].z(), lit[0], lit[1], lit[2], 255});
    }
  }
}

/// Adds a strip that hangs down from a line of vertices.
void add_skirt(Mesh& mesh, std::vector<std::uint32_t>& skirt,
               const std::vector<std::uint32_t>& line, float drop) {
  for (std::size_t i = 0; i < line.size(); ++i) {
    Vertex v = mesh.vertices[line[i]];
    v.z -= drop;
    mesh.vertices.push_back(v);
    if (i == 0) continue;
    const auto low = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
    const std::uint32_t a = line[i - 1], b = line[i];
    skirt.insert(skirt.end(), {a, b, low, a, low, low - 1});
  }
}

// Distances of the rings of the surroundings beyond the edge of the site [m].
constexpr std::array<float, 14> kReach = {0,  0.6f, 1.5f, 3,  5,   8,   12,
                                          18, 27,   40,   65, 110, 250, 900};
// Distance from the edge from which the ground has patches of its own [m].
constexpr float kPlain = 14;
// Number of points of a ring, about, however large the site is.
constexpr int kMostAround = 256;

/// Height in W [m] and colour of a point of the site's edge.
struct EdgePoint {
  float height = 0;
  Vec3f color = Vec3f::Zero();
};

/// Returns the means over `reach` points to both sides along a closed line; over all of it at most.
std::vector<EdgePoint> blurred(const std::vector<EdgePoint>& line, float reach) {
  const auto count = static_cast<int>(line.size());
  const int k = std::min(static_cast<int>(reach), (count - 1) / 2);
  EdgePoint sum;
  const auto add = [&](int i, float share) {
    const EdgePoint& one = line[static_cast<std::size_t>((i + count) % count)];
    sum.height += share * one.height;
    sum.color += share * one.color;
  };
  for (int i = -k; i <= k; ++i) add(i, 1);
  std::vector<EdgePoint> out;
  const float inverse = 1 / static_cast<float>(2 * k + 1);
  for (int i = 0; i < count; ++i) {
    out.push_back({inverse * sum.height, inverse * sum.color});
    add(i - k, -1);
    add(i + k + 1, 1);
  }
  return out;
}

/// Returns the vertex at the distance `reach` outwards from the point `p` of the edge, whose height
/// and colour there are those of `at`.
Vertex outside(const EdgePoint& at, const Vec3f& p, const Vec3f& center, float reach,
               const Vec3f& haze) {
  // Outwards as from a rounded square, so that rings stay apart at corners.
  const Vec3f out = Vec3f(p.x() - center.x(), p.y() - center.y(), 0).normalized();
  const Vec3f q = p + out * reach * 1.3f;
  // Patches end where they would be shorter than the distance between two rings.
  const float patch = value_noise(q.x() / 6, q.y() / 6, 3) * (1 - smooth_step(5, 18, reach)) +
                      value_noise(q.x() / 31, q.y() / 31, 4) * (1 - smooth_step(27, 110, reach));
  Vec3f tone = at.color * (1 + 0.05f * patch * smooth_step(0, kPlain, reach));
  tone += (haze - tone) * 0.25f * smooth_step(4, 150, reach);
  return colored({q.x(), q.y(), at.height}, tone);
}

}  // namespace

std::size_t GroundPart::triangles() const {
  std::size_t count = mesh->indices.size() + mesh->walls.size();
  for (std::size_t k = 0; k < 4; ++k) count += skirts[k] ? mesh->skirts[k].size() : 0;
  return count / 3;
}

void TerrainMesh::update(const scene::FrameGround& ground, const Lighting& lighting) {
  const int old_x = surface_.nx(), old_y = surface_.ny();
  const std::vector<ColumnRect> changed = surface_.update(ground, lighting);
  rebuilt_ = 0;
  if (changed.empty()) return;
  if (old_x != surface_.nx() || old_y != surface_.ny()) {
    tiles_x_ = (surface_.nx() - 2) / kTile + 1;
    tiles_y_ = (surface_.ny() - 2) / kTile + 1;
    if (surface_.nx() < 2 || surface_.ny() < 2) tiles_x_ = tiles_y_ = 0;
    tiles_.assign(static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_), {});
  }
  // A tile shares its last nodes with the next one, and coarse colours average half a stride around
  // them.
  std::vector<ColumnRect> wide;
  wide.reserve(changed.size());
  for (const ColumnRect& rect : changed)
    wide.push_back(rect.grown(1 << (kMaxLevel - 1), surface_.nx(), surface_.ny()));
  for (int ty = 0; ty < tiles_y_; ++ty)
    for (int tx = 0; tx < tiles_x_; ++tx) {
      const bool touched = std::any_of(wide.begin(), wide.end(), [&](const ColumnRect& rect) {
        return tx * kTile < rect.x1 && (tx + 1) * kTile >= rect.x0 && ty * kTile < rect.y1 &&
               (ty + 1) * kTile >= rect.y0;
      });
      if (!touched) continue;
      // Its mesh is rebuilt when it is next visible, at the level that applies then.
      measure(tx, ty);
      tiles_[static_cast<std::size_t>(ty * tiles_x_ + tx)].level = -1;
    }
  const bool at_edge = std::any_of(wide.begin(), wide.end(), [&](const ColumnRect& rect) {
    return rect.x0 == 0 || rect.y0 == 0 || rect.x1 == surface_.nx() || rect.y1 == surface_.ny();
  });
  surroundings_stale_ = surroundings_stale_ || at_edge;
}

void TerrainMesh::measure(int tx, int ty) {
  // The box decides visibility; walls limit how coarse a tile may be.
  Tile& tile = tiles_[static_cast<std::size_t>(ty * tiles_x_ + tx)];
  const int x0 = tx * kTile, y0 = ty * kTile;
  tile.low = surface_.point(x0, y0);
  tile.high = surface_.point(x0 + nodes_x(tx), y0 + nodes_y(ty));
  tile.low.z() = tile.high.z() = surface_.height(x0, y0);
  tile.rough = false;
  for (int iy = y0; iy <= y0 + nodes_y(ty); ++iy)
    for (int ix = x0; ix <= x0 + nodes_x(tx); ++ix) {
      tile.low.z() = std::min(tile.low.z(), surface_.height(ix, iy));
      tile.high.z() = std::max(tile.high.z(), surface_.height(ix, iy));
      // Coarser cells would leave a gap beside loose soil, whose surface is finer.
      if (surface_.loose(ix, iy) ||
          (ix > x0 && std::abs(surface_.height(ix, iy) - surface_.height(ix - 1, iy)) >
                          kWallSlope * surface_.cell()))
        tile.rough = true;
    }
}

int TerrainMesh::wanted_level(const Tile& tile, const View& view, float pixels) const {
  // Uses the nearest point of the box: no part of a tile is coarser than it should be.
  const Vec3f nearest = view.eye.cwiseMax(tile.low).cwiseMin(tile.high);
  const float distance = (nearest - view.eye).norm();
  const float cell_pixels = surface_.cell() * view.pixels_per_radian / std::max(distance, 0.1f);
  // Level ground at a low viewing angle is short in the picture: the mean of the two sides of a
  // cell counts there.
  const float rise = std::max(0.0f, view.eye.z() - tile.high.z()) / std::max(distance, 0.1f);
  pixels *= tile.rough ? 0.35f : 1.0f / std::sqrt(std::clamp(rise, 0.15f, 1.0f));
  int level = 0;
  while (level < kMaxLevel && cell_pixels * static_cast<float>(1 << (level + 1)) <= pixels) ++level;
  return level;
}

int TerrainMesh::neighbour_level(int tile, int dx, int dy, const View& view, float pixels) const {
  // The level to be chosen, not the one last built.
  const int tx = tile % tiles_x_ + dx, ty = tile / tiles_x_ + dy;
  if (tx < 0 || ty < 0 || tx >= tiles_x_ || ty >= tiles_y_) return -1;
  return wanted_level(tiles_[static_cast<std::size_t>(ty * tiles_x_ + tx)], view, pixels);
}

std::vector<GroundPart> TerrainMesh::select(const View& view, int budget) {
  struct Candidate {
    float distance;
    int tile;
  };
  // Nearest first, ties by number: the drawing order is repeatable.
  std::vector<Candidate> seen;
  for (int i = 0; i < tiles_x_ * tiles_y_; ++i) {
    const Tile& tile = tiles_[static_cast<std::size_t>(i)];
    if (!view.sees(tile.low, tile.high)) continue;
    seen.push_back({(view.eye.cwiseMax(tile.low).cwiseMin(tile.high) - view.eye).norm(), i});
  }
  std::sort(seen.begin(), seen.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.tile < b.tile;
  });
  // Finds the finest detail whose triangles fit the budget: a coarse cell covers at most `pixels`
  // of the picture. Coarsens by a quarter until it fits: a few rounds over boxes are cheap compared
  // with one tile too many.
  float pixels = kFinest;
  for (; pixels < 64; pixels *= 1.25f) {
    std::int64_t triangles = 0;
    for (const Candidate& c : seen) {
      const int side =
          kTile >> wanted_level(tiles_[static_cast<std::size_t>(c.tile)], view, pixels);
      triangles += 2 * side * side + 8 * side;
    }
    if (triangles <= budget) break;
  }
  constexpr std::array<std::array<int, 2>, 4> kSides = {{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
  std::vector<GroundPart> out;
  for (const Candidate& c : seen) {
    Tile& tile = tiles_[static_cast<std::size_t>(c.tile)];
    const int level = wanted_level(tile, view, pixels);
    // Reuses the mesh of the last picture if neither ground nor level changed.
    if (tile.level != level) build(c.tile % tiles_x_, c.tile / tiles_x_, level);
    GroundPart part{&tile.mesh, {}, tile.low, tile.high};
    for (std::size_t k = 0; k < 4; ++k)
      part.skirts[k] = neighbour_level(c.tile, kSides[k][0], kSides[k][1], view, pixels) != level;
    out.push_back(part);
  }
  return out;
}

void TerrainMesh::build(int tx, int ty, int level) {
  Tile& tile = tiles_[static_cast<std::size_t>(ty * tiles_x_ + tx)];
  Mesh& mesh = tile.mesh;
  mesh.vertices.clear();
  mesh.indices.clear();
  mesh.walls.clear();
  for (auto& skirt : mesh.skirts) skirt.clear();
  tile.level = level;
  ++rebuilt_;
  const int stride = 1 << level;
  const std::vector<int> xs = nodes(tx * kTile, nodes_x(tx), stride),
                         ys = nodes(ty * kTile, nodes_y(ty), stride);
  const auto width = static_cast<std::uint32_t>(xs.size()),
             rows = static_cast<std::uint32_t>(ys.size());
  // Shared vertices of the level part; walls add separate ones.
  for (const int iy : ys)
    for (const int ix : xs) mesh.vertices.push_back(node_vertex(surface_, ix, iy, stride));

  // Height difference that makes a cell a wall [m].
  const float wall = kWallSlope * surface_.cell();
  for (std::uint32_t j = 0; j + 1 < rows; ++j)
    for (std::uint32_t i = 0; i + 1 < width; ++i) {
      const std::uint32_t a = j * width + i, b = a + 1, c = b + width, d = a + width;
      const float ha = mesh.vertices[a].z, hb = mesh.vertices[b].z, hc = mesh.vertices[c].z,
                  hd = mesh.vertices[d].z;
      // Split along the diagonal whose heights differ less.
      const bool other = std::abs(ha - hc) > std::abs(hb - hd);
      const float range = std::max({ha, hb, hc, hd}) - std::min({ha, hb, hc, hd});
      // At coarser levels walls are too far away to be visible.
      if (level == 0 && range > wall) {
        const int x = xs[i], y = ys[j];
        const std::array<std::array<int, 2>, 4> corner = {
            {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}};
        add_wall(mesh, surface_, corner,
                 other ? std::array{0, 1, 3, 1, 2, 3} : std::array{0, 1, 2, 0, 2, 3});
      } else if (other) {
        mesh.indices.insert(mesh.indices.end(), {a, b, d, b, c, d});
      } else {
        add_quad(mesh, a, b, c, d);
      }
    }

  // Long enough to close any seam to a neighbour of another level.
  const float drop = 0.1f + std::min(3.0f, tile.high.z() - tile.low.z());
  // Each line is ordered such that its skirt faces outwards.
  std::vector<std::uint32_t> south, east, north, west;
  for (std::uint32_t i = 0; i < width; ++i) {
    south.push_back(i);
    north.push_back((rows - 1) * width + (width - 1 - i));
  }
  for (std::uint32_t j = 0; j < rows; ++j) {
    east.push_back(j * width + width - 1);
    west.push_back((rows - 1 - j) * width);
  }
  const std::array<const std::vector<std::uint32_t>*, 4> sides = {&south, &east, &north, &west};
  for (std::size_t k = 0; k < 4; ++k) add_skirt(mesh, mesh.skirts[k], *sides[k], drop);
}

GroundPart TerrainMesh::surroundings(const Lighting& lighting) {
  constexpr float kFar = 1e4f;
  const GroundPart part{
      &surroundings_, {true, false, false, false}, Vec3f::Constant(-kFar), Vec3f::Constant(kFar)};
  if (!surroundings_stale_ || tiles_.empty()) return part;
  surroundings_stale_ = false;
  surroundings_ = {};
  // The edge as one closed line, counter-clockwise from the lower-left corner.
  const int nx = surface_.nx(), ny = surface_.ny();
  const int step = std::max(4, (nx + ny) / kMostAround);
  std::vector<std::array<int, 2>> edge;
  for (int x = 0; x < nx - 1; x += step) edge.push_back({x, 0});
  for (int y = 0; y < ny - 1; y += step) edge.push_back({nx - 1, y});
  for (int x = nx - 1; x > 0; x -= step) edge.push_back({x, ny - 1});
  for (int y = ny - 1; y > 0; y -= step) edge.push_back({0, y});
  const auto around = static_cast<std::uint32_t>(edge.size());
  std::vector<EdgePoint> own;
  for (const auto& [x, y] : edge) {
    const auto& c = surface_.lit(x, y);
    own.push_back({surface_.height(x, y), Vec3f(c[0], c[1], c[2]) / 255.0f});
  }
  const Vec3f center = 0.5f * (surface_.point(0, 0) + surface_.point(nx - 1, ny - 1));
  for (const float reach : kReach) {
    // Farther out each point takes after a longer piece of the edge, or the colours and heights of
    // single columns would be drawn out to streaks.
    const std::vector<EdgePoint> line =
        blurred(own, reach / (static_cast<float>(step) * surface_.cell()));
    for (std::size_t i = 0; i < edge.size(); ++i)
      surroundings_.vertices.push_back(
          outside(line[i], surface_.point(edge[i][0], edge[i][1]), center, reach, lighting.haze));
  }
  for (std::uint32_t ring = 0; ring + 1 < kReach.size(); ++ring)
    for (std::uint32_t i = 0; i < around; ++i) {
      const std::uint32_t k = (i + 1) % around;
      add_quad(surroundings_, ring * around + k, ring * around + i, (ring + 1) * around + i,
               (ring + 1) * around + k);
    }
  // The edge of the site is finer than this mesh: gaps between the two show soil, not sky.
  std::vector<std::uint32_t> line;
  for (std::uint32_t i = 0; i <= around; ++i) line.push_back(i % around);
  add_skirt(surroundings_, surroundings_.skirts[0], line, 2.0f);
  return part;
}

}  // namespace navvy::render
