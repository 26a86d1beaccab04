// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/error.h"
#include "core/file.h"
#include "report/page_template_private.h"
#include "report/run_data.h"

namespace navvy::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostBytes = 5'000'000;  // of a page
constexpr std::size_t kLeastData = 500'000;    // bytes that a run gets in any case

/// Returns text for HTML: no part of it is taken for a tag.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

/// Returns JSON for a script element, which ends at the first "</script>".
std::string script_text(const json& data) {
  std::string out;
  for (const char c : data.dump(-1, ' ', false, json::error_handler_t::replace)) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc));
}

/// Replaces the first `mark` in `page` by `text`.
void fill(std::string& page, std::string_view mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos)
    throw Error("the page that Navvy was built with has no place " + std::string(mark));
  page.replace(at, mark.size(), text);
}

}  // namespace

void write_page(const std::vector<std::string>& folders, const std::string& file) {
  if (folders.empty() || folders.size() > 2)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "report", std::to_string(folders.size()),
                           "a page shows one run, or two side by side",
                           "name one folder of a run or two"});
  std::string page(page_template());
  const std::size_t left = kMostBytes > page.size() ? kMostBytes - page.size() : 0;
  const std::size_t each = std::max(left / folders.size(), kLeastData);
  const std::string page_folder = fs::path(fs::absolute(file)).parent_path().string();
  json data = {{"format", 1}, {"version", NAVVY_VERSION}, {"made", now()}, {"runs", json::array()}};
  std::string title;
  for (const std::string& folder : folders) {
    data["runs"].push_back(run_data(folder, page_folder, each));
    title += (title.empty() ? "" : " and ") + data["runs"].back()["name"].get<std::string>();
  }
  fill(page, "<!--NAVVY:TITLE-->", escaped(title));
  fill(page, "<!--NAVVY:DATA-->",
       "<script type=\"application/json\" id=\"navvy-data\">" + script_text(data) + "</script>");
  write_file_atomically(file, page);
}

}  // namespace navvy::report
