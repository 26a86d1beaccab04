// SPDX-License-Identifier: Apache-2.0
#include <ctime>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/error.h"
#include "report/page_template_private.h"
#include "report/page_text_private.h"

namespace navvy::report {
namespace {

using nlohmann::json;

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

/// Replaces the first `mark` in `page` by `text`.
void fill(std::string& page, std::string_view mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos)
    throw Error("the page that Navvy was built with has no place " + std::string(mark));
  page.replace(at, mark.size(), text);
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&time, &utc);
  char text[32];
  return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc));
}

}  // namespace

json empty_document() {
  return {{"format", 1}, {"version", NAVVY_VERSION}, {"made", now()}, {"runs", json::array()}};
}

std::string filled_page(const std::string& title, const json& data) {
  std::string page(page_template());
  fill(page, "<!--NAVVY:TITLE-->", escaped(title));
  fill(page, "<!--NAVVY:DATA-->",
       "<script type=\"application/json\" id=\"navvy-data\">" + script_text(data) + "</script>");
  return page;
}

}  // namespace navvy::report
