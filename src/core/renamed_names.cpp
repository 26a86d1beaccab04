// SPDX-License-Identifier: Apache-2.0
#include "core/renamed_names.h"

#include <mutex>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/log.h"

namespace navvy {
namespace {

const char* word_for(NameKind kind) {
  switch (kind) {
    case NameKind::kElement:
      return "element";
    case NameKind::kAttributeValue:
      return "value";
    case NameKind::kLayer:
      return "layer";
    case NameKind::kChannel:
      return "channel";
  }
  return "name";
}

/// Returns the length of the old name at the end of `name`; npos if the row does not match.
std::size_t match(const RenamedName& row, NameKind kind, std::string_view name) {
  const std::string_view old = row.old_name;
  if (row.kind != kind || !name.ends_with(old)) return std::string_view::npos;
  const std::size_t before = name.size() - old.size();
  // Channels start with the names of machines and joints.
  const bool whole = before == 0 || (kind == NameKind::kChannel && name[before - 1] == '/');
  return whole ? old.size() : std::string_view::npos;
}

/// Logs a warning unless it was logged before for this file.
void warn_once(const RenamedName& row, const std::string& file, int line) {
  static std::mutex mutex;
  static std::set<std::tuple<NameKind, std::string, std::string>> warned;
  {
    const std::lock_guard lock(mutex);
    if (!warned.emplace(row.kind, row.old_name, file).second) return;
  }
  const std::string where = file.empty() ? "" : file + ":" + std::to_string(line) + ": ";
  log_warning(where + "the " + word_for(row.kind) + " '" + row.old_name + "' is called '" +
              row.name + "' now; the old name is read until release " + row.until);
}

}  // namespace

const std::vector<RenamedName>& renamed_names() {
  // clang-format off
  static const std::vector<RenamedName> rows = {
      {NameKind::kElement, "navvy:engine", "navvy:physics", "0.4"},
      {NameKind::kElement, "awake", "active", "0.4"},
      {NameKind::kElement, "awake_zone", "active_zone", "0.4"},
      {NameKind::kLayer, "awake", "active", "0.4"},
  };
  // clang-format on
  return rows;
}

std::string current_name(NameKind kind, const std::string& name,
                         const std::vector<RenamedName>& table, const std::string& file, int line) {
  for (const RenamedName& row : table) {
    const std::size_t length = match(row, kind, name);
    if (length == std::string_view::npos) continue;
    warn_once(row, file, line);
    return name.substr(0, name.size() - length) + row.name;
  }
  return name;
}

std::string current_name(NameKind kind, const std::string& name, const std::string& file,
                         int line) {
  return current_name(kind, name, renamed_names(), file, line);
}

}  // namespace navvy
