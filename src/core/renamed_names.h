// SPDX-License-Identifier: Apache-2.0
// Names that earlier releases used: elements of files, values, layers and channels.
#pragma once

#include <string>
#include <vector>

namespace navvy {

/// Type of a name. The same word may be renamed differently for different types.
enum class NameKind {
  kElement,         ///< element of a scene file: "navvy:physics"
  kAttributeValue,  ///< "ELEMENT/ATTRIBUTE=VALUE" of a scene file: "navvy:drive/type=linkage"
  kLayer,           ///< layer of a map: "elevation"
  kChannel,         ///< channel of a controller; matches whole parts from its end: "drive/gear"
};

/// An old name and the current name that replaces it.
struct RenamedName {
  NameKind kind;
  const char* old_name;
  const char* name;
  /// First release that no longer accepts the old name.
  const char* until;
};

/// Returns the table of all old names that this release accepts. No other code contains old names.
const std::vector<RenamedName>& renamed_names();

/// Returns the current name for `name`, which may be an old one. Logs a warning for the first use
/// of each old name. A name that is not in the table is returned unchanged. Safe to call from
/// several threads.
std::string current_name(NameKind kind, const std::string& name);
/// Looks up a table other than `renamed_names()`; for tests.
std::string current_name(NameKind kind, const std::string& name,
                         const std::vector<RenamedName>& table);

}  // namespace navvy
