// SPDX-License-Identifier: Apache-2.0
// Interface of the file that cmake/EmbedPage.cmake generates.
#pragma once

#include <string_view>

namespace navvy::report {

/// Returns the page of src/report/page/ with its styles and scripts in it, and without data.
std::string_view page_template();

}  // namespace navvy::report
