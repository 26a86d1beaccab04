// SPDX-License-Identifier: Apache-2.0
// The score of a run as part of summary.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "record/score.h"
#include "scene/scene.h"

namespace navvy::record {

/// Returns the score as a JSON object; names of keys end in their units. `scene` names the
/// machines. Values that cannot be formed, such as an energy per volume without a volume, are
/// absent.
nlohmann::json score_json(const Score& score, const scene::Scene& scene);
/// Returns the judgements of goals as a JSON array. A value that cannot be measured is absent, with
/// its reason in its place.
nlohmann::json goal_list(const std::vector<GoalResult>& goals);

}  // namespace navvy::record
