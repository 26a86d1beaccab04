// SPDX-License-Identifier: Apache-2.0
#include "engine_contract.h"
#include "particle_engine.h"

namespace navvy::vehicle {

INSTANTIATE_TEST_SUITE_P(OutsideTheTree, EngineContract,
                         ::testing::Values(EngineCase{"Particle", example::make_particle_engine}),
                         engine_case_name);

}  // namespace navvy::vehicle
