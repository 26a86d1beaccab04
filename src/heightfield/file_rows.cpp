// SPDX-License-Identifier: Apache-2.0
// Both writers of maps share these heights in the units of the file.
#include "heightfield/file_rows.h"

#include <algorithm>

namespace navvy::heightfield {

// The sum is rounded to float only after the offset of the datum, so that exports read back
// exactly.
void file_rows(const Terrain& terrain, int y0, int y1, std::vector<float>& out) {
  const GroundSetup& setup = terrain.setup();
  const int nx = terrain.nx();
  out.resize(static_cast<std::size_t>(nx) * static_cast<std::size_t>(y1 - y0));
  // Goes block by block in x, so that each untouched tile is computed once for all of these rows.
  constexpr int kBlock = 256;
  for (int x0 = 0; x0 < nx; x0 += kBlock)
    for (int iy = y0; iy < y1; ++iy)
      for (int ix = x0; ix < std::min(x0 + kBlock, nx); ++ix)
        // Computed in double; float is only the limit of the format.
        out[static_cast<std::size_t>(iy - y0) * nx + ix] = static_cast<float>(
            (terrain.height(ix, iy) + setup.height_offset) / setup.file_height_unit);
}

}  // namespace navvy::heightfield
