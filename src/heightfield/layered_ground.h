// SPDX-License-Identifier: Apache-2.0
// The resting ground: columns of layered soil over a bedrock datum, counted in integer mass.
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

/// Columns of layered soil on a regular grid: the live terrain, with its layers, to be dug, filled
/// and pressed.
///
/// Only 32 x 32 tiles that were touched hold columns; the others are computed from the source on
/// reading, so memory and time follow touched tiles, never the site. Every change is mass-exact and
/// announced by a sequence number and a rectangle. Several threads may read at a time; who changes
/// it must be alone with it. Who reads for longer, or in another thread, takes a `view`.
class Ground final : public Terrain {
 public:
  using Setup = GroundSetup;
  /// @throws InputError with every fault of the setup.
  explicit Ground(Setup setup);
  ~Ground();
  Ground(Ground&&) noexcept;
  Ground& operator=(Ground&&) noexcept;

  /// The columns of this moment as a copy that never changes, stamped with `time` [s]. Costs 0.1
  /// us, and 0.01 us a tile changed since the last view; such a tile (14 KiB) is copied when it is
  /// next changed. May be called from several threads.
  TerrainView view(double time = 0) const;

  /// Layers of a column, bottom first (a copy; for untouched columns computed from the source).
  std::vector<SoilLayer> layers(int ix, int iy) const;
  /// Same into a vector that the caller keeps, without allocating in loops.
  void column(int ix, int iy, std::vector<SoilLayer>& out) const;
  /// Same as of the untouched site.
  void start_column(int ix, int iy, std::vector<SoilLayer>& out) const;
  /// Takes off everything above W height z [m] and appends it to `taken`, bottom first; the masses
  /// are exact. Leaves the column's surface at z up to one mass quantum.
  void take_above(int ix, int iy, double z, std::vector<SoilLayer>& taken);
  /// Puts a layer on top; merges with the top layer when soil and density state match (within
  /// 1e-3), volumes added.
  void put(int ix, int iy, const SoilLayer& layer);
  /// Presses the surface down to `height` by raising density (ruts): mass stays, the top layers'
  /// specific volume falls, not below `min_specific_volume`.
  void compact_to(int ix, int iy, double height, float min_specific_volume = 0.85f);

  /// The columns that something stands on just now, by iy * nx + ix; they replace those held until
  /// now. Soil neither leaves them nor slides onto them by itself. Columns let go count as changed,
  /// so that who waited looks again.
  /// @throws Error for a column outside the site; nothing has changed then.
  void hold(std::set<std::int64_t> columns);
  /// As hold, besides those held already.
  void hold_more(const std::set<std::int64_t>& columns);
  bool held(int ix, int iy) const;

  /// Sum over the touched tiles of mass now minus mass at the start, per soil, recounted from the
  /// columns.
  std::vector<std::int64_t> mass_change() const;

  /// Bounding rectangle of what changed after sequence number n (exact for recent n, a superset for
  /// older ones). For the soil, whose own state holds n; all others use a ChangeFollower.
  CellRect changed_since(std::uint64_t sequence) const;

  /// Bounding rectangle of all touched tiles; every column that ever changed lies in it.
  CellRect touched_rect() const;

  std::size_t touched_tiles() const;
  /// Changed columns, the held ones and the log of edits; the untouched site comes from the scene
  /// and is compared in size only. A ChangeFollower sees what loading changed.
  /// @throws InputError for a site of another size or columns that cannot be.
  void visit(Archive& a);

 private:
  struct State;
  void require_inside(int ix, int iy) const;
  void changed(int ix, int iy);
  std::unique_ptr<State> state_;
};

}  // namespace navvy::heightfield
