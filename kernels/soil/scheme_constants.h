// SPDX-License-Identifier: Apache-2.0
// Constants of the particle scheme, defined once for host and kernels. Unlike the constants of a
// soil (law_constants.h) they are the same for every soil, and no scene sets them. `navvy lab
// constants` lists them, and `navvy lab RIG --set scheme.NAME=VALUE` changes one for an experiment.
//
// Kernels, the native loop and the double-precision twin read a constant as SCHEME(name). On the
// device its value is a compile-time literal (soil::scheme_options passes it as a -D option), so a
// changed value causes the kernels to be rebuilt but costs nothing while they run. The host reads
// the members of soil::SchemeConstants. kernels/README.md describes how to add a constant.
#ifndef NAVVY_KERNELS_SOIL_SCHEME_CONSTANTS_H
#define NAVVY_KERNELS_SOIL_SCHEME_CONSTANTS_H

// List of all constants as X(name, default, unit, lowest, highest, description). Units: "cells" is
// a length relative to the edge of a cell; "cell / wave speed" is a time, with the speed of
// compression waves; "sqrt(g cell)" is a speed.
#define SCHEME_CONSTANTS(X) \
  SCHEME_LAW(X)             \
  SCHEME_VOLUME(X)          \
  SCHEME_TRANSFER(X)        \
  SCHEME_CONTACT(X)         \
  SCHEME_EDGE(X)

// Constants of the stress update (law.h) [docs/soil.md, viscosity] [docs/soil.md, opening].
//
// - bank_dilatancy, dilatancy_pressure: a dilatancy angle of 11.5 deg, as dense soil has under
//   little pressure. Fitted to `navvy lab swell`: a load of loam that falls as a block swells to
//   1.22 of 1.23 (1.12 without, 1.18 with 5 kPa). If bonds did not have to break first, the force
//   on a bucket would depend on the active zone (ActiveZone.*: 1.021, at most 1.02; now 1.019).
// - min_density_state limits compaction, and the density of the layers that columns receive from
//   particles. A tighter limit for these layers would turn noise into volume
//   [docs/exchange.md, decisions].
#define SCHEME_LAW(X)                                                                     \
  X(shear_damping, 0.05, "", 0, 0.5,                                                      \
    "shear viscosity of soil that does not yield / (density x wave speed x cell)")        \
  X(volume_damping, 10, "", 0, 30, "bulk viscosity of closed soil / its shear viscosity") \
  X(static_friction_time, 10, "s", 0, 1e6,                                                \
    "inverse of the shear rate at which the static share of the strength has vanished")   \
  X(min_volume_ratio, 0.2, "", 0.01, 0.8, "lowest J, far below any real state")           \
  X(max_volume_ratio, 100, "", 1.5, 1e6, "highest J of soil that opens")                  \
  X(bank_dilatancy, 0.2, "", 0, 0.3,                                                      \
    "plastic volume strain / shear strain of remoulded bank soil without pressure")       \
  X(dilatancy_pressure, 2e4, "Pa", 1, 1e6, "pressure at which soil no longer dilates")    \
  X(min_density_state, 0.88, "", 0.5, 1, "densest J0 that compaction and deposition reach")

// Corrections of a particle's volume by the mean of its cell and by the nodes (point.h)
// [docs/soil.md, mixing] [docs/soil.md, crowding] [docs/soil.md, opening].
//
// - mixing_strain: tuned with CohesiveBlade.MeetsTheFullStrengthAtAnyCohesion and
//   SoilSwell.DugAndDumpedSoilEndsAtItsSwell. The draft of a blade in clay of 150 kPa
//   corresponds to 0.85 of the clay's strength with a value of 0.025, and to 0.83 with 0.1.
// - min_mixing_time: tuned with the same swell test. Without mixing a dumped load comes to rest at
//   1.45 of its bank volume instead of 1.23; mixing by time only gives 1.27 with 0.1 s, 1.24 with
//   0.02 s and 1.22 with 0.005 s.
// - crowding_threshold: J is integrated over time and cannot detect particles that crowd. Loam that
//   was scooped and dumped had 0.97 of its bank volume while its J was 1.24. The correction only
//   separates particles, because nodes beside a free surface or a plate contain less mass than the
//   soil's density would give.
// - crowding_strain: tuned with the plane-strain laboratory. A value of 0.02 stirs heaps at rest;
//   0.2 leaves their core at 1.23 of its density state.
// - max_crowding_displacement: a tenth of the distance between particles.
// - closing_share: an opening closes while a wave travels about twelve cells. Tuned with
//   CohesiveBlade.* and Rigs/GranularLab.MeetsItsGates/ThrowHalf. With a third, thrown sand lands
//   at 1.065 of its volume in cells of 0.05 m; with 1 at 1.092 (1.5 if wide openings close as
//   well). The draft of a blade in clay of 150 kPa corresponds to 0.87 of the clay's strength with
//   a third, 0.86 with a sixth and 0.66 with 0.
#define SCHEME_VOLUME(X)                                                                       \
  X(mixing_strain, 0.025, "", 1e-6, 1e6,                                                       \
    "strain over which J / J0 relaxes to the mean of its cell")                                \
  X(min_mixing_time, 0.02, "s", 1e-6, 1e6, "shortest time over which it relaxes")              \
  X(crowding_threshold, 1.05, "", 1, 2,                                                        \
    "nodal density / density by J and J0 above which soil counts as crowded")                  \
  X(crowding_strain, 0.1, "", 1e-6, 1e6, "shear strain over which crowded particles separate") \
  X(max_crowding_displacement, 0.05, "cells", 0, 0.1,                                          \
    "longest displacement of a crowded particle in a transfer")                                \
  X(closing_share, 1.0 / 6, "", 0, 1,                                                          \
    "share of a numerical opening that closes in a transfer where nodes show closed soil")     \
  X(max_closing_ratio, 1.1, "", 1, 100, "J / J0 up to which an opening counts as numerical")

// Duration of a transfer, and nodes beside ground and plates (node.h) [docs/soil.md, transfer]
// [docs/soil.md, free volume] [docs/soil.md, resting ground].
//
// - transfer_length: four steps at a Courant number of 0.5. Every transfer damps short waves; with
//   a fixed length the damping per time does not depend on the step.
// - max_transfer_motion: weights and near nodes stay those of the transfer's start. Tuned with
//   `navvy lab throw`: without this limit, eight steps per transfer give thrown soil a wrong volume
//   (0.76 of its density state).
// - gap_open, gap_closed: fitted to `navvy lab swell` with dry sand in cells of 0.1 m, whose heap
//   takes 1.185 times its bank volume by its surface (1.265 without; 1.13 wanted, at most 1.187);
//   1.194 with 0.8 and 0.95, 1.208 with 0.6 and 0.95. Soil on the ground has a ratio of about 1.
#define SCHEME_TRANSFER(X)                                                                     \
  X(transfer_length, 2, "cell / wave speed", 0, 16, "longest time between two transfers")      \
  X(max_transfer_motion, 0.2, "cells", 0, 0.25,                                                \
    "longest displacement of a particle or a tool between two transfers")                      \
  X(held_margin, 0.25, "cells", 0, 0.5, "height above the columns up to which nodes are held") \
  X(gap_open, 0.9, "", -1, 1,                                                                  \
    "packing at the topmost held node / above it, up to which soil falls")                     \
  X(gap_closed, 0.95, "", 0.01, 2,                                                             \
    "packing at the topmost held node / above it, from which it rests")                        \
  X(min_free_fraction, 0.25, "", 0.01, 1,                                                      \
    "lowest free fraction of a node's kernel beside ground and plates")

// Contact of soil and tools (contact_law.h, shell_side.h) [docs/tools.md, contact shares]
// [docs/tools.md, stand-off] [docs/tools.md, adhesion].
//
// - contact_max_depth: sum of the longest displacements of particle and tool in a transfer (0.2
//   each), the depth that may remain after a push (0.2), and 0.1 for rounding.
// - contact_full: a node is full until its soil has expanded to 1.5 times its bank volume.
// - contact_bearing_*: tuned with `navvy lab light-tool`. Below a plate, a node whose soil stands
//   off by a quarter of a cell carries 0.8 of the load, and a node with a fill of 0.9 counts as
//   full.
// - contact_touch: not tuned; 0.75 = 1 / 1.33 is the fill at a large swell.
#define SCHEME_CONTACT(X)                                                                         \
  X(contact_band, 2.5, "cells", 1.5, 3,                                                           \
    "distance from a plate within which particles have a side")                                   \
  X(contact_reach, 1, "cells", 0, 2, "clearance at which a node has half of the contact's share") \
  X(contact_ramp, 1, "cells", 0.01, 4, "length over which that share falls from 1 to 0")          \
  X(contact_edge, 0.6, "cells", 0, 2,                                                             \
    "distance inside a free edge at which a node has half of the share along the plate")          \
  X(contact_edge_ramp, 1, "cells", 0.01, 4, "length over which that share falls from 1 to 0")     \
  X(contact_margin, 0.35, "cells", 0.01, 1, "extra reach of the lists of near nodes")             \
  X(contact_max_push, 0.2, "cells", 0, 0.25, "longest push of a particle out of a plate")         \
  X(contact_max_depth, 0.7, "cells", 0, 2.5,                                                      \
    "depth behind a plate beyond which a particle belongs to another plate of the tool")          \
  X(contact_opening, 0.1, "sqrt(g cell)", 0, 10,                                                  \
    "separation speed above which adhesion has ended")                                            \
  X(contact_settling, 0.05, "sqrt(g cell)", 0, 10,                                                \
    "speed at which soil settles towards a plate that does not advance")                          \
  X(contact_falling, 0.5, "sqrt(g cell)", 0, 10,                                                  \
    "speed at which a plate falls through nodes that carry hardly any load")                      \
  X(contact_full, 1.5, "", 0.1, 100, "fullness of a node / its fill, up to 1")                    \
  X(contact_bearing_slope, 4, "", 0.1, 100,                                                       \
    "growth of the carried share with the fill under a plate")                                    \
  X(contact_bearing_offset, 2.6, "", 0, 100,                                                      \
    "slope x fill from which a node under a plate carries load")                                  \
  X(contact_touch, 1 / 0.75, "", 0.1, 100, "wetted share of the area of a node / its fill, up to 1")

// Resistance of the edges of plates (edge_law.h, src/soil/tools/edge.cpp) [docs/tools.md, edges].
//
// - edge_ahead: the nodes that carry the resistance are those around a point at this distance ahead
//   of the edge; nodes behind the edge belong to the plate's faces.
// - edge_spread: tuned with `navvy lab tip`. Nodes give no more than the soil around them carries;
//   in sand and cells of 0.05 m, the end of a plate of 60 mm has 0.76 of Prandtl's value with 0,
//   0.87 with 1 and 0.94 with 2.
// - edge_bond: tuned with `navvy lab tip`. An edge remoulds the soil that it displaces, from intact
//   soil ahead to remoulded soil at the plate. With 1, edges of 60 mm in loam resist by 9.4 kN per
//   0.6 m in cells of 0.1 m, where nothing of that is resolved, and by 7.5 kN in cells of 0.05 m.
// - edge_slow: far below the speeds of digging, far above those of soil at rest.
#define SCHEME_EDGE(X)                                                            \
  X(edge_ahead, 0.5, "cells", 0, 1.5,                                             \
    "distance ahead of an edge at which its resistance acts")                     \
  X(edge_spread, 2, "cells", 0, 3,                                                \
    "width beyond a plate's thickness over which its edge's resistance is spread") \
  X(edge_around, 2, "cells", 0.5, 2.5,                                            \
    "distance from an edge within which soil counts for its strength")            \
  X(edge_bond, 0.5, "", 0, 1,                                                     \
    "share of the cohesion beyond the residual one that counts for edges")        \
  X(edge_slow, 0.01, "sqrt(g cell)", 1e-6, 10,                                    \
    "speed below which a plate counts as standing still for its edges' resistance")

#ifdef __cplusplus
namespace navvy::soil {

/// Default values of the constants; soil/scheme.h gives names, units and ranges at run time.
#define SCHEME_MEMBER(name, value, unit, low, high, help) double name = value;
struct SchemeConstants {
  SCHEME_CONSTANTS(SCHEME_MEMBER)
};
#undef SCHEME_MEMBER

/// The default values of all constants.
inline constexpr SchemeConstants kScheme{};

}  // namespace navvy::soil

// What is compiled for the host (twin, native loop) computes with the defaults.
#define SCHEME(name) static_cast<scalar>(::navvy::soil::kScheme.name)

#elif defined(SCHEME_GIVEN)
// The host passes every constant as -DSCHEME_name=value.
#define SCHEME(name) SCHEME_##name

#else
// Kernels that are compiled alone, by a linter, have the defaults.
#define SCHEME_DEFAULT(name, value, unit, low, high, help) constant float scheme_##name = value;
SCHEME_CONSTANTS(SCHEME_DEFAULT)
#undef SCHEME_DEFAULT
#define SCHEME(name) scheme_##name
#endif

#endif  // NAVVY_KERNELS_SOIL_SCHEME_CONSTANTS_H
