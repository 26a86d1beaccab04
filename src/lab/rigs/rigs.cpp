// SPDX-License-Identifier: Apache-2.0
#include "lab/rigs/rig_list.h"

namespace navvy::lab {
namespace {

/// Adds the parameters of every rig: a result that depends on the step is not a result.
std::vector<Rig> with_common_parameters(std::vector<Rig> list) {
  for (Rig& rig : list)
    rig.parameters.push_back({"courant", 0.66667, "",
                              "the step, as a share of the cell over the speed of sound",
                              between(0.01, 1)});
  return list;
}

}  // namespace

const std::vector<Rig>& rigs() {
  // Created on first use and never changed: setups keep pointers to its entries.
  static const std::vector<Rig> list = with_common_parameters({
      // Soil by itself, from slow to flying.
      rest_rig(),
      column_rig(),
      pour_rig(),
      cone_rig(),
      slope_rig(),
      slide_rig(),
      throw_rig(),
      swell_rig(),
      // One element of it.
      shear_rig(),
      triaxial_rig(),
      // Soil and tools, from a plate in one direction to a bucket on a path.
      blade_rig(),
      wall_rig(),
      footing_rig(),
      plate_rig(),
      tip_rig(),
      wheel_rig(),
      cut_rig(),
      shear_box_rig(),
      hold_rig(),
      light_tool_rig(),
      stand_rig(),
      bucket_rig(),
      scrape_rig(),
      cycle_rig(),
  });
  return list;
}

}  // namespace navvy::lab
