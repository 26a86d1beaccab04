// SPDX-License-Identifier: Apache-2.0
// Parts of the import of foreign files that several sources share.
#pragma once

#include <map>
#include <string>

#include "core/math.h"
#include "scene_io/xml.h"

namespace navvy::scene_io {

/// Collects what is ignored or assumed in a file and reports each kind once, at its first place,
/// with the number of places.
class IgnoredKinds {
 public:
  /// Counts an element of the kind `kind`, e.g. "model/plugin". At the first one, `rule` says what
  /// is done with it and `why` explains it.
  void add(const Element& at, const std::string& kind, const std::string& why,
           const std::string& rule = "is ignored");
  /// Reports one warning for each kind, in the order of their names.
  void report(Faults& faults) const;

 private:
  /// The first place of a kind, and the number of places.
  struct Kind {
    Fault first;
    std::size_t count = 0;
  };
  std::map<std::string, Kind> kinds_;
};

/// Brings an SDF file of another version to 1.9 in place. Unknown versions are left to
/// `check_root`, which reports them.
void upgrade_sdf(Document& document);

/// Removes from a foreign SDF file what has no effect.
void clean_sdf(Document& document, IgnoredKinds& ignored);

/// Gives joints to the world, other than one fixed joint, a link between that is fixed to the
/// world.
void anchor_joints(Document& document);

/// Replaces the root <robot> of a URDF file by <sdf> with a <model>. Returns false after an error.
bool convert_urdf(Document& document, IgnoredKinds& ignored, Faults& faults);

/// Reports text of a URDF or foreign SDF file that a tool of ROS should have replaced: xacro and
/// substitutions such as $(optenv X); plugins of SDF may hold any text. Returns false after such an
/// error.
bool check_expanded(const Element& element, Faults& faults);

/// Reads a number like strtod: 1.8e308 is infinite. Returns `otherwise` for other text.
double loose_number(const std::string& text, double otherwise);

/// Returns a pose as SDF's six numbers.
std::string pose_text(const Pose& X);

/// Appends an element with a text to `parent`; errors in it are reported at `from`.
Element& append(Document& document, Element& parent, const char* name, const Element& from,
                const std::string& text = "");

}  // namespace navvy::scene_io
