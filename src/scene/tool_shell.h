// SPDX-License-Identifier: Apache-2.0
// A shell as data: the thin plates of a tool, which touch soil, with their edges and teeth. All
// values are in SI units and all angles in radians; `describe` documents the elements of a file and
// their units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/math.h"
#include "geometry/triangle_mesh.h"
#include "scene/fields.h"

namespace navvy::scene {

/// Teeth on the cutting edge of a bucket: the ground resists their ends only, not the whole edge
/// [docs/tools.md, teeth].
struct Teeth {
  int number = 5;       ///< number of teeth
  double width = 0.08;  ///< width of each tooth [m]
  double length = 0.2;  ///< length of the teeth ahead of the cutting edge [m]
  double bevel = kPi;   ///< angle between the faces of a tooth at its tip [rad]; pi: blunt

  /// Passes the fields of the <teeth> of a <navvy:bucket> to the visitor `f`.
  void describe(Fields& f) {
    f("number", number, {1, 100}, "Number of teeth.");
    f("width_m", width, {1e-3, 5},
      "Width of each tooth; all together are at most as wide as the bucket.");
    f("length_m", length, {0, 2}, "Length of the teeth ahead of the cutting edge.");
    f("bevel_deg", bevel, {1, 180}, "Angle between the faces of a tooth at its tip; 180: blunt.");
  }
};

/// The cutting edge of a bucket's shell and the teeth on it.
struct ToothedEdge {
  Teeth teeth;                 ///< the teeth; a straight edge is one tooth as wide as the edge
  Vec3 p_tip = Vec3::Zero();   ///< middle of the edge in the link's frame [m]
  Vec3 ahead = Vec3::UnitX();  ///< unit vector along the plate and outward, in the link's frame
  double width = 1;            ///< width of the edge [m]
};

/// A thin shell of triangles in the link's frame [m], which touches soil: a bucket, blade, plate or
/// bed. The front of the triangles is the inside. An edge of only one triangle is a free edge. A
/// shell has two sides and a thickness. It may be open, and then holds soil on its front
/// [docs/tools.md, shells].
struct Shell : geometry::TriangleMesh {
  std::string name;               ///< name of the shell
  std::string link;               ///< name of the link that carries the shell
  double half_thickness = 0.015;  ///< half of the plate's thickness [m]
  /// Factors on the tangent of the soil's tool friction angle (`friction_share`) and on the soil's
  /// adhesion (`adhesion_share`) for contact with this shell [-].
  double friction_share = 1, adhesion_share = 1;
  /// Thickness of the plate at its free edges / thickness of the plate; 0: sharp, without
  /// resistance. Of a bucket's shell only the cutting edge has it; its rims are sharp.
  double edge_share = 0;
  double edge_bevel = kPi;  ///< angle between the faces at a free edge [rad]; pi: blunt
  /// Cutting edge of the bucket that the shell belongs to; not a field of the file's <navvy:shell>.
  std::optional<ToothedEdge> toothed;
  std::string mesh;  ///< OBJ file with the triangles; empty: the file lists them
  /// Coordinates of vertices and indices of triangle corners as the file lists them; cleared once
  /// the triangles have been built.
  std::vector<double> vertex_numbers, corner_numbers;

  /// Passes the fields of a <navvy:shell> to the visitor `f`.
  void describe(Fields& f) {
    f.attribute("name", name, "Name of the shell.", kNeeded);
    f("link", link, Refers::kLink, "Link that carries the shell.", kNeeded);
    f("mesh", mesh, "OBJ file of the surface; of a bucket best the middle surface of its plates.",
      kShown);
    f("vertices_m", vertex_numbers, {-1000, 1000}, "Vertices x y z, instead of a mesh.", kShown);
    f("triangles", corner_numbers, {0, 1e6},
      "Three numbers of vertices, from 0, per triangle; counter-clockwise as seen from the inside "
      "of a bucket, or from outside of a closed body.",
      kShown);
    f.derived_text("surface", [this] { return surface_hash(); });
    f("half_thickness_m", half_thickness, {1e-4, 1}, "Half the thickness of the plate.");
    f("friction_share", friction_share, {0, 2},
      "Share of the tangent of a soil's tool friction angle; 0 with adhesion_share 0: smooth.");
    f("adhesion_share", adhesion_share, {0, 2}, "Share of a soil's adhesion.");
    f("edge_share", edge_share, {0, 1},
      "Thickness of the plate at its free edges, as a share of the plate's; 0: sharp. Only the "
      "cutting edge of a bucket's shell has it.");
    f("edge_bevel_deg", edge_bevel, {1, 180},
      "Angle between the faces of the plate at its free edges; 180: blunt.");
  }

  /// Returns the thickness of the plate at its free edges [m].
  double edge_thickness() const { return 2 * half_thickness * edge_share; }

 private:
  /// Returns a hash of all vertices and triangles, which represents the surface as one parameter.
  std::string surface_hash() const;
};

}  // namespace navvy::scene
