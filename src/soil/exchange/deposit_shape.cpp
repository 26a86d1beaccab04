// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/deposit_shape.h"

#include <algorithm>
#include <cmath>

#include "soil/exchange/spline.h"

namespace navvy::soil {
namespace {

// At a flat surface half of the spline's weight lies in soil, so this value finds it in place.
constexpr double kIso = 0.5;
/// Samples per cell in height.
constexpr int kSamples = 2;
/// Smoothed fraction in the middle of a gap 1.3 cells high. Crumbly soil with narrower gaps is not
/// hollow. Tuned with loam dropped from 0.3 m, whose loose crust reads 0.3.
constexpr double kHollow = 0.2;
/// Centres this far apart have an empty cell and half a particle each between them [cells].
constexpr double kHanging = 1.5;

// Returns the weight of the spline below t, its integral from -infinity: what a column that is full
// up to there adds to a sample.
double spline_sum(double t) {
  if (t <= -1.5) return 0;
  if (t >= 1.5) return 1;
  if (t < -0.5) return (t + 1.5) * (t + 1.5) * (t + 1.5) / 6;
  if (t <= 0.5) return 0.5 + 0.75 * t - t * t * t / 3;
  return 1 - (1.5 - t) * (1.5 - t) * (1.5 - t) / 6;
}

}  // namespace

BlockShape ShapeFinder::find(const PlanKey& block) {
  x0_ = index_.grid().column_x(block, 0);
  y0_ = index_.grid().column_y(block, 0);
  // Columns of the block with a margin of one, as the spline reaches one column to each side.
  std::vector<float> heights;
  ground_.copy_heights({x0_ - 1, y0_ - 1, x0_ + 5, y0_ + 5}, heights);
  double lowest = 0, highest = 0;
  for (std::size_t i = 0; i < around_.size(); ++i) {
    around_[i] = (static_cast<double>(heights[i]) - ground_.datum()) / ground_.cell();
    lowest = i == 0 ? around_[i] : std::min(lowest, around_[i]);
    highest = i == 0 ? around_[i] : std::max(highest, around_[i]);
  }
  // Particles up to two columns away contribute to the samples. Only the highest of each column
  // matters here.
  for (int iy = y0_ - 2; iy < y0_ + 6; ++iy)
    for (int ix = x0_ - 2; ix < x0_ + 6; ++ix) {
      const auto column = index_.column(ix, iy);
      if (!column.empty()) highest = std::max(highest, height_in_cells(index_[column.back()]));
    }
  // From two cells below the lowest column to two above the highest particle, so that the spline is
  // complete everywhere.
  bottom_ = std::floor(lowest) - 2;
  const auto samples = static_cast<std::size_t>(std::ceil((highest + 2 - bottom_) * kSamples)) + 1;

  BlockShape shape;
  for (std::size_t c = 0; c < 16; ++c) {
    fraction_.assign(samples, 0.0);
    const int ix = x0_ + static_cast<int>(c % 4), iy = y0_ + static_cast<int>(c / 4);
    sample_columns(ix, iy);
    sample_particles(ix, iy);
    read(shape, c);
    if (hangs(ix, iy)) shape.hollow = true;
  }
  return shape;
}

// Particles over the column have a gap below them, in it and in the columns around it.
bool ShapeFinder::hangs(int ix, int iy) {
  const auto column = index_.column(ix, iy);
  if (column.empty()) return false;
  // Top of what is known to be supported: the highest surface around, then each particle that lies
  // on it.
  double floor = bottom_;
  heights_.clear();
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      floor = std::max(
          floor, around_[static_cast<std::size_t>((iy + dy - y0_ + 1) * 6 + ix + dx - x0_ + 1)]);
      for (const std::uint32_t i : index_.column(ix + dx, iy + dy))
        heights_.push_back(height_in_cells(index_[i]));
    }
  std::sort(heights_.begin(), heights_.end());
  const double top = height_in_cells(index_[column.back()]);
  // From the lowest up. One gap is enough.
  for (const double z : heights_) {
    if (z > top) break;
    if (z - floor > kHanging) return true;
    floor = std::max(floor, z);
  }
  return false;
}

void ShapeFinder::sample_columns(int ix, int iy) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      // A column weighs as the 2 x 2 particles that it would become, so that seams between the two
      // do not show.
      const double weight = column_weight(dx) * column_weight(dy);
      const double h =
          around_[static_cast<std::size_t>((iy + dy - y0_ + 1) * 6 + ix + dx - x0_ + 1)];
      for (std::size_t k = 0; k < fraction_.size(); ++k)
        fraction_[k] += weight * spline_sum(h - (bottom_ + static_cast<double>(k) / kSamples));
    }
}

void ShapeFinder::sample_particles(int ix, int iy) {
  const double cell = ground_.cell();
  const auto& soils = ground_.setup().soils;
  const PlanGrid& grid = index_.grid();
  for (int dy = -2; dy <= 2; ++dy)
    for (int dx = -2; dx <= 2; ++dx)
      for (const std::uint32_t i : index_.column(ix + dx, iy + dy)) {
        const Particle& p = index_[i];
        const double x = static_cast<double>(kBlockCells) * p.block[0] +
                         static_cast<double>(p.x[0]) - (ix - grid.x + 0.5);
        const double y = static_cast<double>(kBlockCells) * p.block[1] +
                         static_cast<double>(p.x[1]) - (iy - grid.y + 0.5);
        // The spline is a product of its three axes; in plan it is the same for all samples.
        const double plan = spline(x) * spline(y);
        if (plan == 0) continue;
        const double volume = kilograms(p.mass) * static_cast<double>(p.j0) /
                              (soils[p.soil].bank_density * cell * cell * cell);
        const double z = (height_in_cells(p) - bottom_) * kSamples;
        // Only samples within the spline's support of 1.5 cells.
        const int first = std::max(0, static_cast<int>(std::ceil(z - 1.5 * kSamples)));
        const int last = std::min(static_cast<int>(fraction_.size()) - 1,
                                  static_cast<int>(std::floor(z + 1.5 * kSamples)));
        for (int k = first; k <= last; ++k)
          fraction_[static_cast<std::size_t>(k)] += volume * plan * spline((z - k) / kSamples);
      }
}

void ShapeFinder::read(BlockShape& shape, std::size_t c) const {
  const double h = around_[(c / 4 + 1) * 6 + c % 4 + 1];
  shape.ground[c] = shape.surface[c] = h;
  std::size_t k = fraction_.size() - 1;
  // From the top, so that soil which hangs above a void gives the upper surface; the void is found
  // below.
  while (k > 0 && fraction_[k] < kIso) --k;
  if (k + 1 >= fraction_.size() || fraction_[k] < kIso) return;
  // The fraction falls towards the top, so the crossing lies between this sample and the next;
  // linear in between.
  const double within = (fraction_[k] - kIso) / (fraction_[k] - fraction_[k + 1]);
  shape.surface[c] = std::max(h, bottom_ + (static_cast<double>(k) + within) / kSamples);
  // Down to the column's own surface. A sample with little soil is a gap, as the ground below it
  // counts as full.
  for (; k > 0 && bottom_ + static_cast<double>(k) / kSamples > h; --k)
    if (fraction_[k] < kHollow) shape.hollow = true;
}

}  // namespace navvy::soil
