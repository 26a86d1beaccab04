// SPDX-License-Identifier: Apache-2.0
// Makes the page of a run: one HTML file that needs nothing beside it and no network.
#pragma once

#include <string>
#include <vector>

namespace navvy::report {

/// Name of a page in the folder of its run.
inline constexpr const char* kPageName = "report.html";

/// Writes the page of one run, or of two runs side by side, to `file`, which is replaced as a
/// whole. `folders` are those that runs wrote; a run that was killed has a page, too. The page has
/// at most about 5 MB: longer runs are thinned evenly, and the page says so.
/// @throws InputError if there is not one folder or two, or one is none of a run; FileError if the
/// page cannot be written.
void write_page(const std::vector<std::string>& folders, const std::string& file);

/// Returns the text that `write_page` writes. Videos that are too large for the page are linked
/// relative to the folder `page_folder`. @throws InputError as `write_page` does.
std::string page_text(const std::vector<std::string>& folders, const std::string& page_folder);

}  // namespace navvy::report
