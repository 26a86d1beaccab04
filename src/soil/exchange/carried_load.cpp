// SPDX-License-Identifier: Apache-2.0
#include "soil/exchange/carried_load.h"

#include <algorithm>
#include <cmath>

#include "soil/exchange/exchange_index.h"

namespace navvy::soil {
namespace {

/// Least distance of a tool from the ground below it [cells].
constexpr double kAloft = 2;
/// Soil within this distance of the tool's box in plan, and no lower than this
/// below it, counts as the tool's [cells].
constexpr double kBeside = 1;
/// Soil below a tool that is slower than this is at rest [m/s].
constexpr double kSlow = 0.01;
/// Round numbers lie on the edges of columns; they must round the same way
/// everywhere on the site [cells].
constexpr double kNudge = 1e-6;

/// Box of a tool, in columns of the site and cells above the datum.
struct Box {
  Vec2 low, high;
  double bottom;
};

bool slow(const Particle& p) {
  double square = 0;
  for (const float v : p.v) square += static_cast<double>(v) * static_cast<double>(v);
  // Written so that a NaN is not slow.
  return square < kSlow * kSlow;
}

/// Returns true if all columns under the box end well below it.
bool above_columns(const heightfield::Ground& ground, const Box& box) {
  const heightfield::CellRect rect =
      heightfield::CellRect{static_cast<int>(std::floor(box.low.x())),
                            static_cast<int>(std::floor(box.low.y())),
                            static_cast<int>(std::floor(box.high.x())) + 1,
                            static_cast<int>(std::floor(box.high.y())) + 1}
          .cut(ground.site_rect());
  for (int iy = rect.y0; iy < rect.y1; ++iy)
    for (int ix = rect.x0; ix < rect.x1; ++ix)
      if ((ground.height(ix, iy) - ground.datum()) / ground.cell() > box.bottom - kAloft)
        return false;
  return true;
}

}  // namespace

std::vector<std::uint8_t> carried_load(const heightfield::Ground& ground, const PlanGrid& grid,
                                       std::span<const Particle> particles,
                                       std::span<const ToolRegion> tools) {
  std::vector<std::uint8_t> carried(particles.size(), 0);
  std::vector<std::size_t> load;
  for (const ToolRegion& tool : tools) {
    const auto columns = [&](const Vec3& p) {
      return Vec2((p.head<2>() - ground.origin()) / ground.cell() + Vec2::Constant(kNudge));
    };
    const Box box{columns(tool.min), columns(tool.max),
                  (tool.min.z() - ground.datum()) / ground.cell()};
    bool aloft = above_columns(ground, box);
    load.clear();
    for (std::size_t i = 0; i < particles.size() && aloft; ++i) {
      const Particle& p = particles[i];
      const Vec2 at(grid.x + kBlockCells * p.block[0] + static_cast<double>(p.x[0]),
                    grid.y + kBlockCells * p.block[1] + static_cast<double>(p.x[1]));
      if ((at.array() < box.low.array() - kBeside).any() ||
          (at.array() > box.high.array() + kBeside).any())
        continue;
      const double z = height_in_cells(p);
      if (z < box.bottom && z > box.bottom - kAloft && slow(p)) aloft = false;
      if (z >= box.bottom - kBeside) load.push_back(i);
    }
    if (!aloft) continue;
    for (const std::size_t i : load) carried[i] = 1;
  }
  return carried;
}

}  // namespace navvy::soil
