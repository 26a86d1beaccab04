// SPDX-License-Identifier: Apache-2.0
// A digging bucket as data: the link and shell that it consists of, or the numbers of a data sheet
// from which they follow.
#pragma once

#include <optional>
#include <string>

#include "core/math.h"
#include "scene/fields.h"
#include "scene/tool_shell.h"

namespace navvy::scene {

/// Marks a link as a digging bucket. Automatic operators aim the cutting edge according to the
/// members; the soil interacts only with the shell. A bucket without a shell in its file is made of
/// plates by its width, capacity and tip radius; shell, picture, mass and inertia follow
/// (scene_io/bucket_reader.h).
struct Bucket {
  std::string link;           ///< name of the bucket's link
  std::string shell;          ///< name of the bucket's shell
  double capacity = 0.8;      ///< heaped capacity [m3]
  double width = 1.05;        ///< width of the cut [m]
  Vec3 p_tip = Vec3::Zero();  ///< middle of the cutting edge in the link's frame [m]
  /// Unit vector in the link's frame along the bucket's floor, pointing outwards.
  Vec3 cut_direction = Vec3::UnitX();
  /// Unit vector in the link's frame that points out of the bucket's mouth.
  Vec3 opening = Vec3::UnitZ();
  std::optional<Teeth> teeth;  ///< teeth on the cutting edge
  std::string name;            ///< name of the bucket, for readers of the file

  /// File with the values that the element does not give; empty: none.
  std::string ref;
  /// Numbers of a bucket that is made of plates: distance from the pin to the cutting edge (0: that
  /// of `p_tip`), thickness of the plates, and how much narrower than the cut the back is on either
  /// side (negative: 1/30 of the width) [m].
  double tip_radius = 0, plate = 0.03, clearance = -1;
  /// Mass of a bucket that is made of plates [kg]; 0: that of the plates, of steel.
  double mass = 0;

  /// Passes the fields of a <navvy:bucket> to the visitor `f`. What makes a bucket of plates is no
  /// parameter: the shell and the link that follow are.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the bucket, for the reader of the file.", kShown);
    f.attribute("ref", ref,
                "Bucket file with the values that are not given here: the name of a shipped one, "
                "or a path that ends in .sdf.",
                kShown);
    f("link", link, Refers::kLink,
      "Link of the bucket; by default that of the machine's bucket, which is replaced.");
    f("shell", shell, Refers::kShell,
      "Shell of the bucket; without it, shell, picture, mass and inertia follow from the rest.");
    f("capacity_m3", capacity, {1e-4, 100}, "Heaped capacity.");
    f("width_m", width, {0.01, 20}, "Width of the cut.");
    f("tip_m", p_tip,
      "Middle of the cutting edge in the frame of the link; by default that of the bucket that is "
      "replaced.");
    f("cut_direction", Direction{&cut_direction},
      "Direction of the edge, along the floor and outward; only beside a <shell>.");
    f("opening", Direction{&opening}, "Direction out of the mouth.");
    f("teeth", teeth, "Teeth on the cutting edge.");
    f("tip_radius_m", tip_radius, {0.05, 20},
      "Distance from the pin to the cutting edge; by default that of tip_m.", kShown);
    f("plate_m", plate, {1e-3, 0.2}, "Thickness of the plates of a bucket without <shell>.",
      kShown);
    f("side_clearance_m", clearance, {0, 1},
      "The back is narrower than the cut by this much on either side; by default 1/30 of the "
      "width.",
      kShown);
    f("mass_kg", mass, {0.1, 1e5},
      "Mass of a bucket without <shell>; by default that of its plates, of steel.", kShown);
  }
};

}  // namespace navvy::scene
