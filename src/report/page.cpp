// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "report/page_template_private.h"
#include "report/page_text_private.h"
#include "report/run_data.h"

namespace navvy::report {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMostBytes = 5'000'000;  // of a page
constexpr std::size_t kLeastData = 500'000;    // bytes that a run gets in any case

}  // namespace

std::string page_text(const std::vector<std::string>& folders, const std::string& page_folder) {
  if (folders.empty() || folders.size() > 2)
    throw InputError(Fault{Fault::Severity::kError, "", 0, "report", std::to_string(folders.size()),
                           "a page shows one run, or two side by side",
                           "name one folder of a run or two"});
  const std::size_t size = page_template().size();
  const std::size_t left = kMostBytes > size ? kMostBytes - size : 0;
  const std::size_t each = std::max(left / folders.size(), kLeastData);
  json data = empty_document();
  std::string title;
  for (const std::string& folder : folders) {
    data["runs"].push_back(run_data(folder, page_folder, each));
    title += (title.empty() ? "" : " and ") + data["runs"].back()["name"].get<std::string>();
  }
  return filled_page(title, data);
}

void write_page(const std::vector<std::string>& folders, const std::string& file) {
  write_file_atomically(file,
                        page_text(folders, fs::path(fs::absolute(file)).parent_path().string()));
}

}  // namespace navvy::report
