// SPDX-License-Identifier: Apache-2.0
#include "lab/rigs/rig_list.h"
#include "lab/rigs/tool_list.h"

namespace navvy::lab {

const std::vector<Rig>& rigs() {
  static const std::vector<Rig> list = {
      // Soil by itself.
      rest(),
      column(),
      pour(),
      cone(),
      slope(),
      slide(),
      throw_apart(),
      swell(),
      // Soil and tools.
      blade(),
      wall(),
      footing(),
      plate_sinkage(),
      wheel(),
      cut(),
      shear_box(),
      hold(),
      light_tool(),
      bucket(),
      scrape(),
      cycle(),
  };
  return list;
}

}  // namespace navvy::lab
