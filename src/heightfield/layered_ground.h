// SPDX-License-Identifier: Apache-2.0
// The ground at rest: columns of layered soil over a bedrock datum, counted in integer mass.
#pragma once

#include <cstdint>
#include <memory>
#include <set>
#include <vector>

#include "heightfield/soil_layer.h"
#include "heightfield/terrain.h"

namespace navvy {
class Archive;
}

namespace navvy::heightfield {

class TerrainView;

/// Columns of layered soil on a regular grid: the live terrain that is dug, filled and compacted.
///
/// Only tiles of 32 x 32 columns that were touched hold columns. All others are computed from the
/// source on reading, so that memory and time follow the touched tiles and not the size of the
/// site. Every change is mass-exact and announced by a sequence number and a rectangle. Several
/// threads may read at a time; a thread that changes the ground must be alone with it. Readers that
/// need more time, or run in another thread, take a `view`.
class Ground final : public Terrain {
 public:
  using Setup = GroundSetup;
  /// @throws InputError with every fault of the setup.
  explicit Ground(Setup setup);
  ~Ground();
  /// Moves the ground; views stay valid.
  Ground(Ground&&) noexcept;
  Ground& operator=(Ground&&) noexcept;

  /// Returns an immutable copy of the present surface, stamped with `time` [s]. Costs 0.1 us, plus
  /// 0.01 us for each tile that changed since the last view; such a tile (14 KiB) is copied when it
  /// changes next. May be called from several threads.
  TerrainView view(double time = 0) const;

  /// Returns a copy of the layers of a column, bottom first; those of an untouched column are
  /// computed from the source.
  std::vector<SoilLayer> layers(int ix, int iy) const;
  /// Writes the layers into a vector that the caller owns, to avoid allocations in loops.
  void column(int ix, int iy, std::vector<SoilLayer>& out) const;
  /// Writes the layers that the column had on the untouched site.
  void start_column(int ix, int iy, std::vector<SoilLayer>& out) const;
  /// Removes everything above height z in W [m] and appends it to `taken`, bottom first. Masses are
  /// exact. The surface of the column is left at z up to one mass quantum.
  void take_above(int ix, int iy, double z, std::vector<SoilLayer>& taken);
  /// Adds a layer on top. Merges it with the top layer when soil and density state agree (within
  /// 1e-3); volumes add.
  void put(int ix, int iy, const SoilLayer& layer);
  /// Presses the surface down to `height` in W [m] by raising density, as a rut does. Mass stays;
  /// the specific volume of the top layers falls, but not below `min_specific_volume`.
  void compact_to(int ix, int iy, double height, float min_specific_volume = 0.85f);

  /// Replaces the set of columns that carry a load now, given by iy * nx + ix. Soil neither leaves
  /// these columns nor slides onto them by itself. Columns that are released count as changed, so
  /// that processes waiting for them look again.
  /// @throws Error for a column outside the site, without any change.
  void hold(std::set<std::int64_t> columns);
  /// Adds columns to the held ones. @throws Error as hold.
  void hold_more(const std::set<std::int64_t>& columns);
  /// Returns true when column (ix, iy) is held.
  bool held(int ix, int iy) const;

  /// Returns the mass now minus the mass at the start over all touched tiles, per soil, recounted
  /// from the columns [kMassQuantum].
  std::vector<std::int64_t> mass_change() const;

  /// Returns the bounding rectangle of what changed after sequence number `sequence`: exact for
  /// recent numbers, a superset for older ones. Only the soil uses it, because its own state holds
  /// the number; all other clients use a ChangeFollower.
  CellRect changed_since(std::uint64_t sequence) const;

  /// Returns the bounding rectangle of all touched tiles, which holds every column that ever
  /// changed.
  CellRect touched_rect() const;

  /// Returns the number of touched tiles.
  std::size_t touched_tiles() const;
  /// Visits the changed columns, the held ones and the log of edits. The untouched site comes from
  /// the scene; only its size is compared. A ChangeFollower sees what loading changed.
  /// @throws InputError for a site of another size or for impossible columns.
  void visit(Archive& a);

 private:
  struct State;
  /// @throws Error for a column outside the site.
  void require_inside(int ix, int iy) const;
  /// Updates the visible state of a column and logs the edit.
  void changed(int ix, int iy);
  std::unique_ptr<State> state_;
};

}  // namespace navvy::heightfield
