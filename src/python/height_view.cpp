// SPDX-License-Identifier: Apache-2.0
#include "python/height_view.h"

#include <algorithm>
#include <cstddef>

namespace navvy::python {

std::vector<heightfield::CellRect> HeightView::update(const heightfield::TerrainView& view) {
  if (values_ == nullptr || view.nx() != nx_ || view.ny() != ny_) {
    nx_ = view.nx();
    ny_ = view.ny();
    values_ = std::make_shared<std::vector<float>>(static_cast<std::size_t>(nx_) *
                                                   static_cast<std::size_t>(ny_));
    follower_.forget();
  }
  std::vector<heightfield::CellRect> changed = follower_.take(view);
  for (const heightfield::CellRect& rect : changed) {
    view.copy_heights(rect, part_);
    const auto width = static_cast<std::size_t>(rect.x1 - rect.x0);
    for (int iy = rect.y0; iy < rect.y1; ++iy) {
      const std::size_t from = static_cast<std::size_t>(iy - rect.y0) * width;
      const std::size_t to = static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx_) +
                             static_cast<std::size_t>(rect.x0);
      std::copy_n(part_.begin() + static_cast<std::ptrdiff_t>(from), width,
                  values_->begin() + static_cast<std::ptrdiff_t>(to));
    }
  }
  return changed;
}

}  // namespace navvy::python
