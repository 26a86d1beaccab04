// SPDX-License-Identifier: Apache-2.0
// The resting ground: columns of layered soil above bedrock, with masses counted in integers.
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

/// Columns of layered soil on a regular grid: the live terrain that machines dig, fill and compact.
///
/// Layers are stored only for columns that changed, in tiles of 32 x 32 columns. All other columns
/// are computed from the setup on access, so memory and time grow with the changed area and not
/// with the site. Every change conserves mass exactly and increases `sequence`.
///
/// Several threads may read at the same time, but not while another thread changes the ground. A
/// reader that runs beside the simulation takes a `view`.
class Ground final : public Terrain {
 public:
  /// Description of the untouched site.
  using Setup = GroundSetup;
  /// Makes the untouched ground described by `setup`. @throws InputError listing every error of the
  /// setup.
  explicit Ground(Setup setup);
  /// Destroys the ground. Views of it remain valid.
  ~Ground();
  /// Moves the ground. Views of it remain valid.
  Ground(Ground&&) noexcept;
  /// Replaces this ground by another one. Views of either remain valid.
  Ground& operator=(Ground&&) noexcept;

  /// Returns an immutable copy of the current surface, labelled with simulated time `time` [s].
  /// Takes 0.1 us plus 0.01 us for each tile changed since the last view. The next change of such a
  /// tile copies it (14 KiB). Several threads may call this function at the same time.
  TerrainView view(double time = 0) const;

  /// Returns a copy of the soil layers of column (ix, iy), from bottom to top. @throws Error for a
  /// column outside the site.
  std::vector<SoilLayer> layers(int ix, int iy) const;
  /// Writes the soil layers of column (ix, iy) to `out`, from bottom to top. Reusing `out` avoids
  /// allocations in loops. @throws Error for a column outside the site.
  void column(int ix, int iy, std::vector<SoilLayer>& out) const;
  /// Writes the soil layers that column (ix, iy) had on the untouched site to `out`, from bottom to
  /// top. @throws Error for a column outside the site.
  void start_column(int ix, int iy, std::vector<SoilLayer>& out) const;
  /// Removes all soil above world height `z` [m] from column (ix, iy) and appends it to `taken`,
  /// from bottom to top. Mass is conserved exactly; the new surface differs from `z` by at most the
  /// thickness of one mass unit.
  /// @throws Error for a column outside the site.
  void take_above(int ix, int iy, double z, std::vector<SoilLayer>& taken);
  /// Adds `layer` on top of column (ix, iy). It is merged with the top layer if soil and density
  /// state agree (within 1e-3); the volumes then add up. A layer without mass changes nothing.
  /// @throws Error for a column outside the site, or for a layer with invalid values.
  void put(int ix, int iy, const SoilLayer& layer);
  /// Compacts column (ix, iy) until its surface is at world height `height` [m], as a wheel does in
  /// a rut. The mass is unchanged. The specific volume of the uppermost soil decreases, but not
  /// below `min_specific_volume` (volume / bank volume), so the surface may remain higher.
  /// @throws Error for a column outside the site.
  void compact_to(int ix, int iy, double height, float min_specific_volume = 0.85f);

  /// Replaces the set of held columns, which are the columns that carry a load, such as a wheel.
  /// Each is given by the key iy * nx + ix. Soil in a held column stays in place, and no other soil
  /// slides onto it. Columns that are released count as changed, so that the soil checks them
  /// again.
  /// @throws Error for a column outside the site; the set is then unchanged.
  void hold(std::set<std::int64_t> columns);
  /// Adds `columns` to the set of held columns, with keys as in `hold`. @throws Error for a column
  /// outside the site.
  void hold_more(const std::set<std::int64_t>& columns);
  /// Returns true if column (ix, iy) is in the set of held columns.
  bool held(int ix, int iy) const;

  /// Returns the current mass minus the initial mass of the ground, one entry per soil
  /// [kMassQuantum]. The sum is recomputed from all changed columns.
  std::vector<std::int64_t> mass_change() const;

  /// Returns the bounding rectangle of all columns changed after sequence number `sequence`. It is
  /// exact for recent numbers and may be too large for older ones. Only the soil uses this
  /// function, because it saves the sequence number in its own state; other clients use a
  /// ChangeFollower.
  CellRect changed_since(std::uint64_t sequence) const;

  /// Returns the bounding rectangle of all tiles with a changed column; empty if no column ever
  /// changed.
  CellRect touched_rect() const;

  /// Returns the number of tiles with a changed column.
  std::size_t touched_tiles() const;
  /// Saves or loads the changed columns, the held columns and the log of edits. The untouched site
  /// is not saved: it comes from the scene, and only its size and datum are compared. A
  /// ChangeFollower reports the columns that loading changed.
  /// @throws InputError for a site of another size or datum, or for impossible columns.
  void visit(Archive& a);

 private:
  /// Changed tiles, log of edits, held columns and lock of a ground.
  struct State;
  /// Checks that column (ix, iy) lies on the site. @throws Error if it does not.
  void require_inside(int ix, int iy) const;
  /// Updates the surface of column (ix, iy) after a change of its layers, and logs the edit.
  void changed(int ix, int iy);
  /// Layers, edits and held columns; null only in a ground that was moved from.
  std::unique_ptr<State> state_;
};

}  // namespace navvy::heightfield
