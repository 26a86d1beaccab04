// SPDX-License-Identifier: Apache-2.0
#include "heightfield/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "heightfield/change_log.h"
#include "heightfield/column.h"
#include "heightfield/tiles.h"

namespace navvy::heightfield {
namespace {

// Rut zone: the top two cells carry most of a tyre's compaction. tuned: Ground.CompactsTheTopFirst
constexpr double kCompactionCells = 2.0;
constexpr std::uint32_t kStateVersion = 1;

class SetupCheck {
 public:
  void require(bool good, const std::string& element, const std::string& value, const std::string& rule,
               const std::string& remedy = "") {
    if (!good) faults_.push_back({Fault::Severity::kError, "", 0, element, value, rule, remedy});
  }
  void finish() {
    if (!faults_.empty()) throw InputError(std::move(faults_));
  }

 private:
  std::vector<Fault> faults_;
};

void check_layers(const Ground::Setup& setup, const std::vector<scene::GroundLayer>& layers, SetupCheck& check) {
  check.require(!layers.empty(), "ground/layers", "", "needs at least one layer", "add a navvy:layer");
  for (const scene::GroundLayer& layer : layers) {
    const bool known = std::any_of(setup.soils.begin(), setup.soils.end(),
                                   [&](const scene::Soil& soil) { return soil.name == layer.soil; });
    check.require(known, "ground/layer/soil", layer.soil, "no soil of this name", "name one of the scene's soils");
    check.require(std::isfinite(layer.thickness) && layer.thickness >= 0, "ground/layer/thickness",
                  std::to_string(layer.thickness), "must be a finite length >= 0 m");
  }
}

void check_setup(const Ground::Setup& setup) {
  SetupCheck check;
  // Columns are numbered with int; 2^30 a side would be 100 000 km of 0.1 m cells.
  const int most = 1 << 30;
  check.require(setup.nx > 0 && setup.nx <= most && setup.ny > 0 && setup.ny <= most, "ground/size",
                std::to_string(setup.nx) + " x " + std::to_string(setup.ny) + " columns", "needs at least one column");
  check.require(std::isfinite(setup.cell) && setup.cell > 0, "ground/cell", std::to_string(setup.cell),
                "must be a finite length > 0 m");
  check.require(std::isfinite(setup.datum) && setup.origin.allFinite(), "ground/origin", "",
                "datum and origin must be finite");
  check.require(setup.surface != nullptr, "ground/surface", "", "a source of heights is needed");
  check.require(!setup.soils.empty() && setup.soils.size() < 65536, "ground/soils", std::to_string(setup.soils.size()),
                "needs 1 to 65535 soils");
  for (const scene::Soil& soil : setup.soils)
    check.require(std::isfinite(soil.bank_density) && soil.bank_density > 0, "soil[" + soil.name + "]/bank_density",
                  std::to_string(soil.bank_density), "must be > 0 kg/m3");
  check_layers(setup, setup.layers, check);
  for (const scene::GroundPatch& patch : setup.patches) check_layers(setup, patch.layers, check);
  check.finish();
}

// Like std::clamp, but a NaN gives `low` instead of an undefined conversion later.
double bounded(double value, double low, double high) { return value > low ? std::min(value, high) : low; }

// Smallest t in [0, range] with f0 + f1 t + f2 t^2 <= 0, negative when there is none.
double first_root(double f0, double f1, double f2, double range) {
  if (f0 <= 0) return 0;
  const double end = f0 + (f1 + f2 * range) * range;
  // Roots by the form that does not cancel [Press et al. 2007, Numerical Recipes, 5.6].
  const double discriminant = f1 * f1 - 4 * f2 * f0;
  if (discriminant >= 0) {
    const double q = -0.5 * (f1 + std::copysign(std::sqrt(discriminant), f1));
    double best = -1;
    for (const double t : {q != 0 ? f0 / q : -1.0, f2 != 0 ? q / f2 : -1.0})
      if (t >= 0 && t <= range && (best < 0 || t < best)) best = t;
    if (best >= 0) return best;
  }
  return end <= 0 ? range : -1;
}

}  // namespace

struct Ground::State {
  explicit State(Setup s) : setup(std::move(s)), tiles(setup) {}
  Setup setup;
  Tiles tiles;
  ChangeLog changes;

  double height(int ix, int iy) const {
    return tiles.heights(ix / kTileSide, iy / kTileSide)[(iy % kTileSide) * kTileSide + ix % kTileSide];
  }
  double clamped_height(int ix, int iy) const {
    return height(std::clamp(ix, 0, setup.nx - 1), std::clamp(iy, 0, setup.ny - 1));
  }
  /// Heights at the corners (ix, iy), (ix+1, iy), (ix, iy+1), (ix+1, iy+1) of the dual cell between column centres.
  void corners(int ix, int iy, double z[4]) const {
    if (ix >= 0 && iy >= 0 && ix + 1 < setup.nx && iy + 1 < setup.ny && ix % kTileSide + 1 < kTileSide &&
        iy % kTileSide + 1 < kTileSide) {
      const double* h = tiles.heights(ix / kTileSide, iy / kTileSide) + (iy % kTileSide) * kTileSide + ix % kTileSide;
      z[0] = h[0], z[1] = h[1], z[2] = h[kTileSide], z[3] = h[kTileSide + 1];
      return;
    }
    z[0] = clamped_height(ix, iy), z[1] = clamped_height(ix + 1, iy);
    z[2] = clamped_height(ix, iy + 1), z[3] = clamped_height(ix + 1, iy + 1);
  }
  /// Dual cell that holds W (x, y) and the position in it, 0..1; far outside the site the last one.
  void locate(double x, double y, int& ix, int& iy, double& u, double& v) const {
    const double gx = bounded((x - setup.origin.x()) / setup.cell - 0.5, -1, setup.nx);
    const double gy = bounded((y - setup.origin.y()) / setup.cell - 0.5, -1, setup.ny);
    ix = static_cast<int>(std::floor(gx));
    iy = static_cast<int>(std::floor(gy));
    u = gx - ix;
    v = gy - iy;
  }
  void changed(int ix, int iy) {
    tiles.update_height(ix, iy);
    changes.add(ix, iy);
  }
  void require_inside(int ix, int iy) const {
    if (ix < 0 || iy < 0 || ix >= setup.nx || iy >= setup.ny)
      throw Error("Ground: column (" + std::to_string(ix) + ", " + std::to_string(iy) + ") is outside the site of " +
                  std::to_string(setup.nx) + " x " + std::to_string(setup.ny));
  }
};

Ground::Ground(Setup setup) {
  check_setup(setup);
  state_ = std::make_unique<State>(std::move(setup));
}
Ground::~Ground() = default;
Ground::Ground(Ground&&) noexcept = default;
Ground& Ground::operator=(Ground&&) noexcept = default;

int Ground::nx() const { return state_->setup.nx; }
int Ground::ny() const { return state_->setup.ny; }
double Ground::cell() const { return state_->setup.cell; }
const Vec2& Ground::origin() const { return state_->setup.origin; }
double Ground::datum() const { return state_->setup.datum; }
const Ground::Setup& Ground::setup() const { return state_->setup; }
std::size_t Ground::touched_tiles() const { return state_->tiles.touched().size(); }

Vec2i Ground::column_at(double x, double y) const {
  // Far outside it saturates: no undefined conversion, and still outside.
  const Setup& s = state_->setup;
  const double far = 1e9;
  return {static_cast<int>(bounded(std::floor((x - s.origin.x()) / s.cell), -far, far)),
          static_cast<int>(bounded(std::floor((y - s.origin.y()) / s.cell), -far, far))};
}

double Ground::height(int ix, int iy) const { return state_->clamped_height(ix, iy); }

double Ground::start_height(int ix, int iy) const {
  ix = std::clamp(ix, 0, nx() - 1);
  iy = std::clamp(iy, 0, ny() - 1);
  return state_->tiles.start_heights(ix / kTileSide, iy / kTileSide)[(iy % kTileSide) * kTileSide + ix % kTileSide];
}

double Ground::sample(double x, double y) const {
  int ix, iy;
  double u, v, z[4];
  state_->locate(x, y, ix, iy, u, v);
  state_->corners(ix, iy, z);
  return (1 - v) * ((1 - u) * z[0] + u * z[1]) + v * ((1 - u) * z[2] + u * z[3]);
}

Vec3 Ground::normal(double x, double y) const {
  int ix, iy;
  double u, v, z[4];
  state_->locate(x, y, ix, iy, u, v);
  state_->corners(ix, iy, z);
  const double dx = ((1 - v) * (z[1] - z[0]) + v * (z[3] - z[2])) / cell();
  const double dy = ((1 - u) * (z[2] - z[0]) + u * (z[3] - z[1])) / cell();
  return Vec3(-dx, -dy, 1).normalized();
}

void Ground::column(int ix, int iy, std::vector<Layer>& out) const {
  state_->require_inside(ix, iy);
  const Column* found = state_->tiles.find_column(ix, iy);
  if (found != nullptr)
    out = *found;
  else
    state_->tiles.start_column(ix, iy, out);
}

void Ground::start_column(int ix, int iy, std::vector<Layer>& out) const {
  state_->require_inside(ix, iy);
  state_->tiles.start_column(ix, iy, out);
}

std::vector<Layer> Ground::layers(int ix, int iy) const {
  Column out;
  column(ix, iy, out);
  return out;
}

std::uint16_t Ground::surface_soil(int ix, int iy) const {
  ix = std::clamp(ix, 0, nx() - 1);
  iy = std::clamp(iy, 0, ny() - 1);
  const Column* found = state_->tiles.find_column(ix, iy);
  return found != nullptr && !found->empty() ? found->back().soil : state_->tiles.start_surface_soil(ix, iy);
}

double Ground::surface_volume_ratio(int ix, int iy) const {
  const Column* found = state_->tiles.find_column(std::clamp(ix, 0, nx() - 1), std::clamp(iy, 0, ny() - 1));
  return found != nullptr && !found->empty() ? found->back().specific_volume : 1;
}

void Ground::take_above(int ix, int iy, double z, std::vector<Layer>& taken) {
  state_->require_inside(ix, iy);
  if (!(z < height(ix, iy))) return;
  heightfield::take_above(state_->tiles.touch_column(ix, iy), z - datum(), state_->tiles.unit(), taken);
  state_->changed(ix, iy);
}

void Ground::put(int ix, int iy, const Layer& layer) {
  state_->require_inside(ix, iy);
  if (layer.mass == 0) return;
  if (layer.mass < 0 || layer.soil >= state_->setup.soils.size() || !std::isfinite(layer.specific_volume) ||
      !(layer.specific_volume > 0) || !std::isfinite(layer.plastic_shear))
    throw Error("Ground::put: a layer of soil " + std::to_string(layer.soil) + ", mass " + std::to_string(layer.mass) +
                " units, specific volume " + std::to_string(layer.specific_volume) + " is not soil");
  heightfield::put(state_->tiles.touch_column(ix, iy), layer);
  state_->changed(ix, iy);
}

void Ground::compact_to(int ix, int iy, double height_wanted, float min_specific_volume) {
  state_->require_inside(ix, iy);
  const double drop = height(ix, iy) - height_wanted;
  if (!(drop > 0) || !(min_specific_volume > 0)) return;
  compact(state_->tiles.touch_column(ix, iy), drop, kCompactionCells * cell(), min_specific_volume,
          state_->tiles.unit());
  state_->changed(ix, iy);
}

std::vector<std::int64_t> Ground::mass_change() const {
  std::vector<std::int64_t> sum = state_->tiles.start_mass();
  for (std::int64_t& mass : sum) mass = -mass;
  for (const auto& [key, tile] : state_->tiles.touched())
    for (const Column& column : tile->columns)
      for (const Layer& layer : column) sum[layer.soil] += layer.mass;
  return sum;
}

void Ground::volume_change(double& raised, double& lowered) const {
  raised = lowered = 0;
  for (const auto& [key, tile] : state_->tiles.touched())
    for (int i = 0; i < kTileColumns; ++i)
      if (tile->slot[i] >= 0) {
        const double change = (tile->height[i] - tile->start_height[i]) * cell() * cell();
        (change > 0 ? raised : lowered) += std::abs(change);
      }
}

std::uint64_t Ground::sequence() const { return state_->changes.sequence(); }
CellRect Ground::changed_since(std::uint64_t sequence) const {
  return state_->changes.since(sequence, CellRect{0, 0, nx(), ny()});
}

CellRect Ground::touched_rect() const {
  CellRect rect;
  for (const auto& [key, tile] : state_->tiles.touched()) {
    const int x = static_cast<int>(key % state_->tiles.tiles_x()) * kTileSide;
    const int y = static_cast<int>(key / state_->tiles.tiles_x()) * kTileSide;
    rect.include(CellRect{x, y, std::min(x + kTileSide, nx()), std::min(y + kTileSide, ny())});
  }
  return rect;
}

void Ground::copy_heights(const CellRect& rect, std::vector<float>& out) const {
  out.clear();
  if (rect.empty()) return;
  out.resize(static_cast<std::size_t>(rect.x1 - rect.x0) * static_cast<std::size_t>(rect.y1 - rect.y0));
  // Tile by tile, so that each untouched tile is computed once even when the cache is too small for a row of them.
  const auto tile_of = [](int i, int n) { return std::clamp(i, 0, n - 1) / kTileSide; };
  for (int ty = tile_of(rect.y0, ny()); ty <= tile_of(rect.y1 - 1, ny()); ++ty)
    for (int tx = tile_of(rect.x0, nx()); tx <= tile_of(rect.x1 - 1, nx()); ++tx) {
      // The tiles at the edge of the site also answer for what lies outside.
      const int last_tx = (nx() - 1) / kTileSide, last_ty = (ny() - 1) / kTileSide;
      const int x0 = tx == 0 ? rect.x0 : std::max(rect.x0, tx * kTileSide);
      const int x1 = tx == last_tx ? rect.x1 : std::min(rect.x1, (tx + 1) * kTileSide);
      const int y0 = ty == 0 ? rect.y0 : std::max(rect.y0, ty * kTileSide);
      const int y1 = ty == last_ty ? rect.y1 : std::min(rect.y1, (ty + 1) * kTileSide);
      const double* h = state_->tiles.heights(tx, ty);
      for (int iy = y0; iy < y1; ++iy) {
        float* row = out.data() + static_cast<std::size_t>(iy - rect.y0) * (rect.x1 - rect.x0);
        const double* from = h + (std::clamp(iy, 0, ny() - 1) % kTileSide) * kTileSide;
        for (int ix = x0; ix < x1; ++ix)
          row[ix - rect.x0] = static_cast<float>(from[std::clamp(ix, 0, nx() - 1) % kTileSide]);
      }
    }
}

double Ground::ray(const Vec3& p, const Vec3& d, double range) const {
  const double cell = this->cell();
  const auto along = [&](int axis) { return (p[axis] - origin()[axis]) / cell - 0.5; };
  const double gx = along(0), gy = along(1), dx = d.x() / cell, dy = d.y() / cell;
  int ix = static_cast<int>(bounded(std::floor(gx), -1e9, 1e9));
  int iy = static_cast<int>(bounded(std::floor(gy), -1e9, 1e9));
  if (!p.allFinite() || !d.allFinite()) return -1;
  if (p.z() <= sample(p.x(), p.y())) return 0;
  const double infinity = std::numeric_limits<double>::infinity();
  const auto exit_of = [&](double g, double dg, int i) {
    return dg > 0 ? (i + 1 - g) / dg : dg < 0 ? (i - g) / dg : infinity;
  };
  // Walk the dual cells between column centres; in each the surface is bilinear and the ray's height above it a
  // quadratic in t.
  double t0 = 0;
  while (t0 < range) {
    const double tx = exit_of(gx, dx, ix), ty = exit_of(gy, dy, iy);
    const double t1 = std::min({tx, ty, range});
    double z[4];
    state_->corners(ix, iy, z);
    const double b = z[1] - z[0], c = z[2] - z[0], e = z[3] - z[2] - b;
    const double u = gx + dx * t0 - ix, v = gy + dy * t0 - iy;
    const double f0 = p.z() + d.z() * t0 - (z[0] + b * u + c * v + e * u * v);
    const double f1 = d.z() - b * dx - c * dy - e * (u * dy + v * dx), f2 = -e * dx * dy;
    const double hit = first_root(f0, f1, f2, t1 - t0);
    if (hit >= 0) return t0 + hit;
    if (tx <= ty) ix += dx > 0 ? 1 : -1;
    if (ty <= tx) iy += dy > 0 ? 1 : -1;
    t0 = std::max(t1, t0);
  }
  return -1;
}

void Ground::hash(StateHash& hash) const {
  for (const auto& [key, tile] : state_->tiles.touched()) {
    hash.value(key);
    for (int i = 0; i < kTileColumns; ++i) {
      if (tile->slot[i] < 0) continue;
      hash.value(i);
      for (const Layer& layer : tile->columns[tile->slot[i]]) {
        hash.value(layer.soil);
        hash.value(layer.mass);
        hash.value(layer.specific_volume);
        hash.value(layer.plastic_shear);
      }
    }
  }
}

void Ground::save(StateWriter& writer) const {
  const Setup& s = state_->setup;
  writer.begin("ground", kStateVersion);
  writer.value(s.nx);
  writer.value(s.ny);
  writer.value(s.cell);
  writer.value(s.datum);
  writer.value(static_cast<std::uint64_t>(touched_tiles()));
  for (const auto& [key, tile] : state_->tiles.touched()) {
    writer.value(key);
    writer.value(static_cast<std::uint32_t>(tile->columns.size()));
    for (int i = 0; i < kTileColumns; ++i) {
      if (tile->slot[i] < 0) continue;
      const Column& column = tile->columns[tile->slot[i]];
      writer.value(static_cast<std::uint16_t>(i));
      writer.value(static_cast<std::uint32_t>(column.size()));
      for (const Layer& layer : column) {
        writer.value(layer.soil);
        writer.value(layer.mass);
        writer.value(layer.specific_volume);
        writer.value(layer.plastic_shear);
      }
    }
  }
  state_->changes.save(writer);
  writer.end();
}

void Ground::load(StateReader& reader) {
  const Setup& s = state_->setup;
  const auto require = [](bool good, const char* rule) {
    if (!good)
      throw InputError(Fault{Fault::Severity::kError, "snapshot", 0, "ground", "", rule,
                             "load it into the scene it was saved from"});
  };
  reader.begin("ground", kStateVersion);
  const auto snx = reader.value<int>(), sny = reader.value<int>();
  const auto scell = reader.value<double>(), sdatum = reader.value<double>();
  require(snx == s.nx && sny == s.ny && scell == s.cell && sdatum == s.datum, "the site has another size or datum");
  state_->tiles.clear();
  const auto tiles = reader.value<std::uint64_t>();
  for (std::uint64_t t = 0; t < tiles; ++t) {
    const auto key = reader.value<std::int64_t>();
    const auto columns = reader.value<std::uint32_t>();
    require(key >= 0 && columns <= kTileColumns, "a tile is outside the site");
    for (std::uint32_t n = 0; n < columns; ++n) {
      const int i = reader.value<std::uint16_t>();
      const std::int64_t ix = key % state_->tiles.tiles_x() * kTileSide + i % kTileSide;
      const std::int64_t iy = key / state_->tiles.tiles_x() * kTileSide + i / kTileSide;
      require(ix < s.nx && iy < s.ny && i < kTileColumns, "a column is outside the site");
      Column& column = state_->tiles.touch_column(static_cast<int>(ix), static_cast<int>(iy));
      column.clear();
      const auto count = reader.value<std::uint32_t>();
      for (std::uint32_t k = 0; k < count; ++k) {
        Layer layer;
        layer.soil = reader.value<std::uint16_t>();
        layer.mass = reader.value<std::int64_t>();
        layer.specific_volume = reader.value<float>();
        layer.plastic_shear = reader.value<float>();
        require(layer.soil < s.soils.size() && layer.mass > 0 && layer.specific_volume > 0 &&
                    std::isfinite(layer.specific_volume) && std::isfinite(layer.plastic_shear),
                "a layer is not soil");
        column.push_back(layer);
      }
      state_->tiles.update_height(static_cast<int>(ix), static_cast<int>(iy));
    }
  }
  state_->changes.load(reader);
  reader.end();
}

}  // namespace navvy::heightfield
