// SPDX-License-Identifier: Apache-2.0
// Names that earlier releases used for elements of files, values, map layers and channels.
#pragma once

#include <string>
#include <vector>

namespace navvy {

/// Type of a name. The same text may be used by names of different types independently.
enum class NameKind {
  kElement,  ///< element of a scene file, e.g. "navvy:physics"
  /// Value of an attribute as "ELEMENT/ATTRIBUTE=VALUE", e.g. "navvy:drive/type=linkage".
  kAttributeValue,
  kLayer,  ///< layer of a map, e.g. "elevation"
  /// Channel of a controller; an entry also matches the last parts of a longer name, e.g.
  /// "drive/gear" that of "digger/drive/gear".
  kChannel,
};

/// One renamed name: an entry of `renamed_names()`.
struct RenamedName {
  NameKind kind;         ///< type of the name
  const char* old_name;  ///< name in earlier releases
  const char* name;      ///< current name
  const char* until;     ///< first release that no longer accepts the old name
};

/// Returns the table of this release. No other code contains old names.
const std::vector<RenamedName>& renamed_names();

/// Returns the current name for `name` if that is an old name of the type `kind`, otherwise `name`
/// unchanged. Logs a warning at the first use of each old name in `file`, with file and `line`;
/// an empty `file` stands for names that come from no file. Thread-safe.
std::string current_name(NameKind kind, const std::string& name, const std::string& file = "",
                         int line = 0);
/// Returns the current name for `name` according to `table` instead of `renamed_names()`; for
/// tests.
std::string current_name(NameKind kind, const std::string& name,
                         const std::vector<RenamedName>& table, const std::string& file = "",
                         int line = 0);

}  // namespace navvy
