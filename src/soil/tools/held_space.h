// SPDX-License-Identifier: Apache-2.0
// The space in which a tool holds soil, prepared for queries of many points.
#pragma once

#include <cstdint>
#include <vector>

#include "core/math.h"
#include "soil/tools/shell_geometry.h"

namespace navvy::soil {

/// Answers ShellGeometry::holds for many points, with the same result.
///
/// The box around the space is divided into cells. The first point in a cell classifies it: most
/// cells are in or out as a whole, and the others list the planes that decide. A query takes some
/// 20 ns instead of up to a microsecond, a first one in its cell some microseconds. Memory is 4
/// bytes for each of at most 14 000 cells, from the first query on, and some hundred bytes for each
/// cell at the edge. Not thread-safe.
class HeldSpace {
 public:
  /// Prepares for the tool of `geometry`, which must outlive this object.
  explicit HeldSpace(const ShellGeometry& geometry);

  /// Returns true if the tool holds soil at `p` in the tool's frame T [m].
  bool holds(const Vec3& p);

 private:
  /// Part of the points of a cell for which a condition holds.
  enum class Part : std::uint8_t { kUnknown, kNone, kSome, kAll };
  struct Cell {
    /// Part that is held.
    Part held = Part::kUnknown;
    /// Index in `edges_` if a part is held.
    std::uint16_t edge = 0;
  };
  /// Limits of the held space in a cell.
  struct Edge {
    /// Planes of the convex hull that pass through the cell.
    std::vector<geometry::Plane> hull;
    /// Triangles that can be closest to a point of the cell, in ascending order; empty if all of
    /// the cell is in front of the shell.
    std::vector<int> triangles;
    /// Planes of the triangles; normals point to the front.
    std::vector<geometry::Plane> plates;
  };
  /// Classifies the cell with these indices along x, y and z.
  Cell classify(const Eigen::Array3i& at);
  /// Adds the planes of the convex hull that pass through the cell around `centre`. Returns false
  /// if the cell is outside the hull.
  bool find_hull(const Vec3& centre, Edge& edge) const;
  /// Adds the triangles that can be closest to a point of the cell around `centre`. Returns the
  /// part of the cell that is known to be in front of them.
  Part find_triangles(const Vec3& centre, Edge& edge);

  const ShellGeometry& geometry_;
  /// Corners of the box in T [m].
  Eigen::Array3d low_, high_;
  /// Edge of a cell [m].
  double edge_;
  /// Number of cells along each axis.
  Eigen::Array3i count_;
  /// Cells, x fastest; empty before the first query.
  std::vector<Cell> cells_;
  /// Limits in the cells of which a part is held.
  std::vector<Edge> edges_;
  /// Triangle closest to the centre of the cell that was classified last: a neighbour often
  /// follows.
  int closest_ = 0;
};

}  // namespace navvy::soil
