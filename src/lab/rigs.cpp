// SPDX-License-Identifier: Apache-2.0
#include "lab/rig_list.h"

namespace navvy::lab {

const std::vector<Rig>& rigs() {
  static const std::vector<Rig> list = {
      rest(), column(), pour(), cone(), slope(),
  };
  return list;
}

}  // namespace navvy::lab
