// SPDX-License-Identifier: Apache-2.0
// What a page shows of one run, read from the run's folder.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace navvy::report {

/// Returns the data of a run of which only the name and the folder are known.
nlohmann::json empty_run(const std::string& name, const std::string& folder);

/// Returns the data of the run in `folder`, in the form that the scripts of the page read
/// (src/report/page/README.md). Frames and rows of telemetry are thinned evenly until the text has
/// about `most` bytes, with a note that says so; videos of at most 2 MB are part of the data,
/// larger ones are named, relative to the folder `page_folder`. What is missing or cannot be read
/// is null, with a note.
/// @throws InputError if the folder is none of a run.
nlohmann::json run_data(const std::string& folder, const std::string& page_folder,
                        std::size_t most);

}  // namespace navvy::report
