// SPDX-License-Identifier: Apache-2.0
#include "vehicle/engine_contract.h"

namespace navvy::vehicle {

INSTANTIATE_TEST_SUITE_P(InTheTree, EngineContract,
                         ::testing::Values(EngineCase{"Bullet", make_bullet_engine},
                                           EngineCase{"Kinematic",
                                                      [](const Vec3&, const scene::Materials&) {
                                                        return make_kinematic_engine();
                                                      },
                                                      false}),
                         engine_case_name);

}  // namespace navvy::vehicle
