// SPDX-License-Identifier: Apache-2.0
// Rules for elements of SDF 1.9: which of them Navvy uses, and how it treats the others.
#pragma once

#include <string>
#include <vector>

#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Checks all SDF elements (those outside the namespace `navvy:`) below `element`. Reports unknown
/// elements, unsupported elements (an error if ignoring them would change the physics, otherwise a
/// warning), values that are not numbers or are out of range, and missing names. Of extension
/// elements it only checks that they are allowed at their position.
void check_sdf(const Element& element, Faults& faults);

/// Returns true if `element` is an SDF element that Navvy uses; false for extension elements,
/// unknown elements and ignored ones.
bool is_used_sdf(const Element& element);
/// Returns true if Navvy uses the SDF element `name` inside an element `parent`.
bool is_used_sdf(const char* parent, const char* name);

/// Treatment of an SDF element: Navvy reads it, ignores it because it only changes the look,
/// ignores it for another reason, refuses it, or does not know it.
enum class SdfTreatment { kRead, kLook, kIgnored, kRefused, kUnknown };
/// Returns the treatment of the SDF element `name` inside an element `parent`. Writes the remedy
/// for an element that is not read into `why`, which may be null.
SdfTreatment sdf_treatment(const char* parent, const char* name, std::string* why = nullptr);

/// One rule that states whether Navvy reads, ignores or refuses certain SDF elements; the reference
/// page lists these rules.
struct SdfUse {
  /// Names of parent elements, and names of the child elements to which the rule applies; the names
  /// in each list are separated by blanks.
  std::string parents, names;
  std::string use;  ///< what Navvy does with the child elements: "read", "ignored" or "refused"
  std::string why;  ///< remedy for an element that is not read; may be empty
};
/// Returns the rules for all SDF elements, in the order of the table of rules.
std::vector<SdfUse> sdf_uses();

/// Checks that the root element is <sdf> with a supported version, as `import_document` leaves it.
/// Returns false after an error.
bool check_root(const Element& root, Faults& faults);

}  // namespace navvy::scene_io
