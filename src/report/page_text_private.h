// SPDX-License-Identifier: Apache-2.0
// Puts data into the page that Navvy was built with.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace navvy::report {

/// Returns the data of a page without its runs.
nlohmann::json empty_document();

/// Returns the page with a title and its data, which reach a browser as text and never as markup.
std::string filled_page(const std::string& title, const nlohmann::json& data);

}  // namespace navvy::report
