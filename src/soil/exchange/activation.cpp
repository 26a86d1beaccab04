// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/activation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "scene/soil_values.h"

namespace navvy::soil {
namespace {

/// Pressure never compresses a particle below this share of its volume, far beyond any column;
/// keeps j positive.
constexpr double kMostCompression = 0.5;
/// Particles of a layer: 2 x 2 in plan.
constexpr int kInPlan = 2, kPerLayer = kInPlan * kInPlan;

double thickness_of(const heightfield::SoilLayer& layer, double density, double cell) {
  return kilograms(layer.mass) * static_cast<double>(layer.specific_volume) /
         (density * cell * cell);
}

}  // namespace

Activator::Activator(heightfield::Ground& ground, PlanGrid grid, double gravity)
    : ground_(ground), grid_(grid), gravity_(gravity), cell_(ground.cell()) {
  for (const scene::Soil& soil : ground.setup().soils) {
    law_.push_back(law_constants(soil, cell_));
    if (scene::heaviest_particle(soil, cell_) / kMassQuantum >
        std::numeric_limits<std::int32_t>::max())
      throw InputError(Fault{Fault::Severity::kError, "", 0, "solver/cell", std::to_string(cell_),
                             "a particle of soil '" + soil.name + "' would weigh more than 128 kg",
                             "use a smaller cell"});
  }
}

int Activator::particle_bound(double thickness) const {
  // Two more soils may each round up to one more layer. A bound for the budget, not for memory: a
  // column of many thin soils may give a few more.
  return kPerLayer * (static_cast<int>(std::ceil(2 * std::max(thickness, 0.0) / cell_)) + 2);
}

// Divides the taken layers [first, last), of one soil, into equal slices; `bottom` is where they
// start above the cut.
void Activator::slice(std::size_t first, std::size_t last, double bottom) {
  const std::uint16_t soil = taken_[first].soil;
  const double density = ground_.setup().soils[soil].bank_density;
  double thickness = 0;
  // The whole thickness first: slices are equal, so that no thin remainder becomes a particle of
  // its own.
  for (std::size_t i = first; i < last; ++i) thickness += thickness_of(taken_[i], density, cell_);
  const int count = std::max(1, static_cast<int>(std::lround(2 * thickness / cell_)));

  // Iterate over layers and slices together; `below` is the mass below the current height.
  std::size_t layer = first;
  double layer_bottom = 0, below = 0, shear_below = 0;
  std::int64_t given = 0;
  double last_below = 0, last_shear = 0;
  for (int k = 0; k < count; ++k) {
    const double top = thickness * (k + 1) / count;
    float least = std::numeric_limits<float>::max(), most = 0;
    double at = below, shear_at = shear_below;
    while (true) {
      const heightfield::SoilLayer& l = taken_[layer];
      least = std::min(least, l.specific_volume);
      most = std::max(most, l.specific_volume);
      const double layer_thickness = thickness_of(l, density, cell_),
                   mass = static_cast<double>(l.mass);
      const bool ends_here = layer_bottom + layer_thickness > top || layer + 1 == last;
      const double share =
          layer_thickness > 0 ? std::clamp((top - layer_bottom) / layer_thickness, 0.0, 1.0) : 1.0;
      at = below + (ends_here ? share : 1.0) * mass;
      shear_at =
          shear_below + (ends_here ? share : 1.0) * mass * static_cast<double>(l.plastic_shear);
      if (ends_here) break;
      layer_bottom += layer_thickness;
      below += mass;
      shear_below += mass * static_cast<double>(l.plastic_shear);
      ++layer;
    }
    // The last slice takes the exact sum, whatever the doubles rounded to.
    std::int64_t upto = std::llround(at);
    if (k + 1 == count) {
      upto = 0;
      for (std::size_t i = first; i < last; ++i) upto += taken_[i].mass;
    }
    Slice out{soil, upto - given, bottom + thickness * k / count, thickness / count, 1, 0};
    if (out.mass > 0) {
      const double volume = out.thickness * cell_ * cell_ * density / kilograms(out.mass);
      // Rounding of the mass must not make soil denser or looser than any layer of the slice.
      out.specific_volume = std::clamp(static_cast<float>(volume), least, most);
      out.shear = static_cast<float>(
          std::max(0.0, (shear_at - last_shear) / std::max(at - last_below, 1e-300)));
      slices_.push_back(out);
    }
    given = upto;
    last_below = at;
    last_shear = shear_at;
  }
}

// Sets the stress of soil at rest under `weight` [N/m2], and the volume that belongs to its
// pressure.
void Activator::stress(const Slice& slice, double weight, Particle& particle) const {
  const LawConstants& law = law_[slice.soil];
  const double nu = ground_.setup().soils[slice.soil].poisson;
  // Strength in this density state and after remoulding, as in the law [docs/soil.md, cohesion].
  const double dense = std::clamp(
      law.dense_offset - static_cast<double>(slice.specific_volume) * law.inv_range, 0.0, 1.0);
  const double soft = 1 + static_cast<double>(slice.shear) * law.inv_remould;
  const double strength = law.k_loose + law.k_dense * dense + law.k_bond / (soft * soft);
  // K0 of an elastic half space, or what the yield surface allows: (1 - K0) w / sqrt 3 <= alpha p +
  // k.
  const double root = 1 / std::sqrt(3.0);
  const double bound = weight > 0 ? (weight * (root - law.alpha / 3) - strength) /
                                        (weight * (root + 2 * law.alpha / 3))
                                  : 0;
  const double k0 = std::clamp(std::max(nu / (1 - nu), bound), 0.0, 1.0);
  const double pressure = weight * (1 + 2 * k0) / 3;
  // Deviatoric stress, positive in tension; the pressure is stored in the volume.
  particle.s[0] = particle.s[1] = static_cast<float>(pressure - k0 * weight);
  particle.s[2] = static_cast<float>(pressure - weight);
  particle.j = static_cast<float>(static_cast<double>(slice.specific_volume) *
                                  (1 - std::min(pressure / law.bulk, kMostCompression)));
}

void Activator::activate(int ix, int iy, double z_bottom, double load,
                         std::vector<Particle>& born) {
  taken_.clear();
  slices_.clear();
  // `take_above` cuts a layer in two where needed, exact to the quantum.
  ground_.take_above(ix, iy, std::max(z_bottom, ground_.datum()), taken_);
  const double cut = ground_.height(ix, iy);

  // Runs of one soil, from the bottom up.
  double bottom = 0;
  for (std::size_t first = 0; first < taken_.size();) {
    std::size_t last = first;
    double thickness = 0;
    for (; last < taken_.size() && taken_[last].soil == taken_[first].soil; ++last)
      thickness +=
          thickness_of(taken_[last], ground_.setup().soils[taken_[last].soil].bank_density, cell_);
    slice(first, last, bottom);
    bottom += thickness;
    first = last;
  }

  // Weight above a slice: the load on the column, every slice over it, and half of its own.
  double above = load;
  for (const Slice& s : slices_) above += kilograms(s.mass);
  const double to_pressure = gravity_ / (cell_ * cell_);
  for (const Slice& s : slices_) {
    above -= kilograms(s.mass);
    Particle p;
    p.soil = s.soil;
    p.j0 = s.specific_volume;
    p.shear = s.shear;
    stress(s, (above + 0.5 * kilograms(s.mass)) * to_pressure, p);
    // Heights count from the present end of the column, which is within a quantum of the height
    // asked for.
    const double z = (cut - ground_.datum() + s.bottom + 0.5 * s.thickness) / cell_;
    const int cells[3] = {ix - grid_.x, iy - grid_.y, static_cast<int>(std::floor(z))};
    const double offset[3] = {0, 0, z - cells[2]};
    for (int k = 0; k < kPerLayer; ++k) {
      // Quanta that do not divide by four go to the first particles.
      p.mass = static_cast<std::int32_t>(s.mass / kPerLayer + (k < s.mass % kPerLayer ? 1 : 0));
      if (p.mass == 0) continue;
      const double plan[3] = {(k % kInPlan + 0.5) / kInPlan, (k / kInPlan + 0.5) / kInPlan, 0};
      for (int a = 0; a < 3; ++a) {
        // Rounded down also for cells below zero, as blocks count from the grid's corner, which may
        // lie within the site.
        p.block[a] =
            cells[a] >= 0 ? cells[a] / kBlockCells : -((kBlockCells - 1 - cells[a]) / kBlockCells);
        p.x[a] = static_cast<float>(cells[a] - kBlockCells * p.block[a] + plan[a] + offset[a]);
      }
      born.push_back(p);
    }
  }
}

}  // namespace navvy::soil
