// SPDX-License-Identifier: Apache-2.0
#include "report/live_page.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "report/page_text_private.h"
#include "report/replay_reader.h"
#include "report/run_data.h"

namespace navvy::report {

using nlohmann::json;

std::string live_page(const std::string& name, const std::string& header, const json& live) {
  json run = empty_run(name, "");
  read_header(header, run);
  json data = empty_document();
  data["runs"].push_back(std::move(run));
  data["live"] = live;
  std::string page = filled_page(name, data);
  // The page receives the run from its own server, and from nowhere else.
  const std::string policy = "default-src 'none';";
  const std::size_t at = page.find(policy);
  if (at == std::string::npos) throw Error("the page that Navvy was built with has no policy");
  return page.replace(at, policy.size(), policy + " connect-src 'self';");
}

}  // namespace navvy::report
