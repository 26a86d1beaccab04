// SPDX-License-Identifier: Apache-2.0
#include "coupling/track_ruts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "terramechanics/bearing.h"
#include "terramechanics/plate.h"

namespace navvy::coupling {

// Excess soil leaves the column before the rest is compacted to its new height.
void TrackRuts::press_column(const PushedSoil::Place& place, double pressure, double most) {
  const int ix = place.ix, iy = place.iy;
  const double width = place.width;
  const scene::Soil& soil = ground_.setup().soils[ground_.surface_soil(ix, iy)];
  RutMemory& memory = ruts_.history(ix, iy);
  const double height = ground_.height(ix, iy);
  memory.find(height);
  // Cleared, not begun anew: the law of repeated passes is measured for tyres, and a column sees
  // all segments of a track as one load. A track therefore ends at the larger of both depths, not
  // on the depth that the last tyre found. A tyre that comes later adds to the track's depth.
  memory.leave();
  const auto [before, drop, work] = memory.press(soil, width, height, pressure, most);
  if (!(drop > 0)) return;
  (void)work;  // the track's resistance follows from its own depth
  const terramechanics::SoilState state{&soil, ground_.specific_volume(ix, iy)};
  pushed_.take(place, terramechanics::pushed_depth(state, width, before, before + drop));
  ground_.compact_to(ix, iy, height - drop);
  memory.height = ground_.height(ix, iy);
}

// Finds the heaviest segment over each column first, then presses every column once.
void TrackRuts::press(const std::vector<terramechanics::TrackPatch>& patches, double most,
                      bool alone) {
  // A column between two segments carries the heavier one once; each segment presses only by the
  // excess of its pressure.
  std::map<std::int64_t, std::pair<double, PushedSoil::Place>> under;  // pressure [Pa]
  for (const terramechanics::TrackPatch& patch : patches) {
    const Vec2 along = patch.ahead_W.head<2>().normalized(), across(-along.y(), along.x());
    const Vec2 middle = patch.p_W.head<2>();
    // Wide enough for one column on either side of its middle, as for tyres: the track is supported
    // between both.
    const double half_width = std::max(0.5 * patch.width, ground_.cell());
    const double reach = std::hypot(0.5 * patch.length, half_width);
    const double pressure = patch.load / (patch.length * patch.width);
    const Vec2i low = ground_.column_at(middle.x() - reach, middle.y() - reach);
    const Vec2i high = ground_.column_at(middle.x() + reach, middle.y() + reach);
    for (int iy = std::max(low.y(), 0); iy <= std::min(high.y(), ground_.ny() - 1); ++iy)
      for (int ix = std::max(low.x(), 0); ix <= std::min(high.x(), ground_.nx() - 1); ++ix) {
        const Vec2 d = ground_.origin() + ground_.cell() * Vec2(ix + 0.5, iy + 0.5) - middle;
        if (std::abs(d.dot(along)) > 0.5 * patch.length || std::abs(d.dot(across)) > half_width)
          continue;
        auto& bears = under[static_cast<std::int64_t>(iy) * ground_.nx() + ix];
        if (pressure > bears.first || (pressure == bears.first && patch.width > bears.second.width))
          bears = {pressure,
                   {ix, iy, across, d.dot(across), 0.5 * patch.width, patch.width,
                    PushedSoil::covered(d.dot(across), patch.width, ground_.cell())}};
      }
  }
  std::set<std::int64_t> columns;
  for (const auto& [key, bears] : under) {
    press_column(bears.second, bears.first, most);
    columns.insert(key);
  }
  pushed_.deposit_down([&](int ix, int iy) {
    return ground_.held(ix, iy) ||
           columns.count(static_cast<std::int64_t>(iy) * ground_.nx() + ix) != 0;
  });
  if (alone)
    ground_.hold(std::move(columns));
  else
    ground_.hold_more(columns);
}

}  // namespace navvy::coupling
