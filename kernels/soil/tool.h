// SPDX-License-Identifier: Apache-2.0
// Structs of tools and of the contact with them, shared by host and kernels. They hold scalars and
// arrays of scalars only.
//
// Coordinates of a tool are relative to the corner of its window, the block that contains its
// origin, so that floats are as precise a kilometre from the site's origin. Lengths are in cells,
// directions along the axes of W.
#ifndef NAVVY_KERNELS_SOIL_TOOL_H
#define NAVVY_KERNELS_SOIL_TOOL_H

// Parameters of the contact; lengths in cells.
//
// h: clearance from the plate's face at which a node has half of the share
//
// ramp: length over which that share falls to zero
//
// edge, edge_ramp: the same along the plate, from its free edge
//
// patch: face of a cell x dt [m2 s]
//
// opening: separation speed above which adhesion has ended [m/s]
//
// settling: speed at which soil at the end of the reach settles towards a plate that does not
// advance [m/s]
//
// falling: speed at which a plate falls onto soil through nodes that carry hardly any load [m/s]
//
// down_x, down_y, down_z: unit vector of gravity, or zero
#define REACH_FIELDS(X) \
  X(h)                  \
  X(ramp)               \
  X(edge)               \
  X(edge_ramp)          \
  X(patch)              \
  X(opening)            \
  X(settling)           \
  X(falling)            \
  X(down_x)             \
  X(down_y)             \
  X(down_z)

#ifdef __cplusplus
#include <cstddef>
namespace navvy::soil {

/// REACH_FIELDS as kernel arguments. The arithmetic of contact_law.h has them in its own precision.
#define REACH_FLOAT(name) float name;
struct ContactReach {
  REACH_FIELDS(REACH_FLOAT)
};
#undef REACH_FLOAT
#endif

// One tool in this step.
typedef struct Tool {
  // Block whose corner is the origin of its coordinates.
  int window[3];
  // 1 when the tool takes part in this step.
  int active;
  // Origin of the tool's frame, from the window's corner [cells].
  float origin[3];
  // Half of the thickness of its plates [cells].
  float half_thickness;
  // Angular velocity [rad/s] and velocity of the origin [m/s]; the two-way solve changes it.
  float twist[6];
  // Twist before soil acts.
  float start[6];
  // Change of twist per impulse (moment about the origin, impulse), row major. 0: scripted.
  float inverse_mass[36];
  // Factor on the soil's tool friction (its tangent).
  float friction;
  // Factor on the soil's adhesion x plate area / sum of the areas that its nodes stand for.
  float adhesion;
} Tool;

// Direction that separates front and back at the closest point, and whether the plate ends there.
typedef struct ShellFeature {
  float normal[3];
  // 1 on a free edge.
  float free;
} ShellFeature;

// One triangle of a tool's shell. The face is feature 0, the edges ab bc ca are 1..3, the corners a
// b c are 4..6.
typedef struct ShellTriangle {
  float a[3];
  int tool;
  float b[3];
  // Distance of the farthest corner from the centre.
  float radius;
  float c[3];
  float unused;
  ShellFeature feature[7];
} ShellTriangle;

// One free edge of a shell.
typedef struct ShellRim {
  float start[3];
  int tool;
  float along[3];
  float unused;
} ShellRim;

// Position of a node near a shell.
typedef struct NodeShell {
  // Normal, towards the node if the node is in front.
  float normal[3];
  // Distance from the plate's middle, positive in front [cells].
  float distance;
  // Distance along the plate to its free edge [cells].
  float inset;
  float unused[3];
} NodeShell;

// Change of one field of a node by contact.
typedef struct ContactRecord {
  // Velocity before contact [m/s].
  float before[3];
  // Mass [kg].
  float mass;
  // Velocity after contact and before resting ground acts [m/s].
  float after[3];
  // Normal impulse [N s].
  float push;
} ContactRecord;

// Sums of the two-way solve over the nodes of a near block. Added word by word.
#define CONTACT_SUM_WORDS 28
typedef struct ContactSums {
  // Moment about the tool's origin [N m s], impulse [N s].
  float wrench[6];
  // Upper triangle of the slope of the wrench against the twist, row by row.
  float stiffness[21];
  float unused;
} ContactSums;

#ifdef __cplusplus
static_assert(sizeof(ContactReach) == 44);
static_assert(sizeof(Tool) == 232 && offsetof(Tool, origin) == 16 && offsetof(Tool, twist) == 32 &&
              offsetof(Tool, inverse_mass) == 80 && offsetof(Tool, adhesion) == 228);
static_assert(sizeof(ShellFeature) == 16 && sizeof(ShellTriangle) == 160 &&
              offsetof(ShellTriangle, feature) == 48);
static_assert(sizeof(ShellRim) == 32 && offsetof(ShellRim, along) == 16);
static_assert(sizeof(NodeShell) == 32 && offsetof(NodeShell, inset) == 16);
static_assert(sizeof(ContactRecord) == 32 && offsetof(ContactRecord, after) == 16);
static_assert(sizeof(ContactSums) == 4 * CONTACT_SUM_WORDS);
}  // namespace navvy::soil
#endif

#endif  // NAVVY_KERNELS_SOIL_TOOL_H
