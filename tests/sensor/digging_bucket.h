// SPDX-License-Identifier: Apache-2.0
// A bucket that digs, for sensors that look at it.
#pragma once

#include <string>

namespace navvy::sensor::testing {

/// Returns the bucket on slides of scenarios/bucket_path.sdf with the elements `sensors`. It is in
/// the ground from 1 s on, cuts 0.3 m deep along x from -1 to 0.4, and is out of it at 4.6 s.
inline std::string digging_bucket(const std::string& sensors) {
  return R"(<include><uri>model://test_bucket</uri><name>bucket</name><pose>0 0 0 0 0 0</pose>
<navvy:on_ground>false</navvy:on_ground>
<navvy:joint name="slide_x"><initial_m>-1.6</initial_m></navvy:joint>
<navvy:joint name="slide_z"><initial_m>0.6</initial_m></navvy:joint>
<navvy:joint name="curl"><initial_deg>-70</initial_deg></navvy:joint>)" +
         sensors + R"(<navvy:program><trajectory><times_s>0 0.5 1.7 3.7 5.2 6.7</times_s>
<joint name="slide_x"><positions_m>-1.6 -1.6 -1.0 0.2 0.45 0.45</positions_m></joint>
<joint name="slide_z"><positions_m>0.6 0.37 0.067 0.067 0.45 1.3</positions_m></joint>
<joint name="curl"><positions_deg>-70 -70 -70 -62 0 0</positions_deg></joint>
</trajectory></navvy:program></include>)";
}

}  // namespace navvy::sensor::testing
