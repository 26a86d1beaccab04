// SPDX-License-Identifier: Apache-2.0
// Makes the page of a run that goes on, to be served.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace navvy::report {

/// Returns a page that shows a run as it goes on: it is served from an address at which `events` is
/// a stream of frames, and `control` takes commands (src/report/page/README.md). `header` is the
/// first row of a replay, and `live` describes what the page may command.
/// @throws InputError if `header` is not that of a replay.
std::string live_page(const std::string& name, const std::string& header,
                      const nlohmann::json& live);

}  // namespace navvy::report
