// SPDX-License-Identifier: Apache-2.0
// One function per rig; each returns the description of its rig. To add a rig, put a file into this
// folder, a line into this header and a line into rigs.cpp. The command line, its help and the
// parameter checks follow from the description.
#pragma once

#include "lab/rig.h"

namespace navvy::lab {

// `navvy lab RIG --help` prints what each rig does, its parameters and examples.

// Rigs without tools.
/// Returns the description of the rig `rest`, which simulates level ground at rest, whose vertical
/// and horizontal stresses are measured.
Rig rest_rig();
/// Returns the description of the rig `column`, which simulates the collapse of a released plane or
/// round column of sand.
Rig column_rig();
/// Returns the description of the rig `pour`, which simulates a heap that is poured from a stream
/// of particles.
Rig pour_rig();
/// Returns the description of the rig `cone`, which simulates heaps that are built at a given
/// angle.
Rig cone_rig();
/// Returns the description of the rig `slope`, which simulates a long slope of sand that starts to
/// flow and stops.
Rig slope_rig();
/// Returns the description of the rig `slide`, which simulates a block that slides on a plane with
/// Coulomb friction.
Rig slide_rig();
/// Returns the description of the rig `throw`, which simulates soil that is thrown apart in a bin
/// and must settle to its former volume.
Rig throw_rig();
/// Returns the description of the rig `swell`, which simulates bank soil that is dumped from a
/// bucket and swells.
Rig swell_rig();
/// Returns the description of the rig `shear`, which simulates the shear of a soil sample in plane
/// strain.
Rig shear_rig();
/// Returns the description of the rig `triaxial`, which simulates triaxial compression and
/// extension of a soil sample.
Rig triaxial_rig();

// Rigs with tools.
/// Returns the description of the rig `blade`, which simulates a flat blade that is pushed through
/// the ground.
Rig blade_rig();
/// Returns the description of the rig `wall`, which simulates a retaining wall under active or
/// passive earth pressure.
Rig wall_rig();
/// Returns the description of the rig `footing`, which simulates a strip footing on weightless
/// soil.
Rig footing_rig();
/// Returns the description of the rig `plate`, which simulates a plate that is pressed into the
/// ground.
Rig plate_rig();
/// Returns the description of the rig `tip`, which simulates a thin plate that is pushed edge first
/// into the ground and held.
Rig tip_rig();
/// Returns the description of the rig `wheel`, which simulates one wheel at a prescribed slip.
Rig wheel_rig();
/// Returns the description of the rig `cut`, which simulates vertical cuts of several heights in
/// cohesive soil.
Rig cut_rig();
/// Returns the description of the rig `box`, which simulates a direct shear test in a shear box.
Rig shear_box_rig();
/// Returns the description of the rig `hold`, which simulates a bucket held still, which must carry
/// the weight of its load.
Rig hold_rig();
/// Returns the description of the rig `light-tool`, which simulates a plate lighter than the soil
/// it falls on, which must not gain energy.
Rig light_tool_rig();
/// Returns the description of the rig `stand`, which simulates a body that sinks into the ground
/// until it stands.
Rig stand_rig();
/// Returns the description of the rig `bucket`, which simulates a bucket that is filled along a
/// path.
Rig bucket_rig();
/// Returns the description of the rig `scrape`, which simulates a bucket that is pressed flat on
/// level ground and dragged.
Rig scrape_rig();
/// Returns the description of the rig `cycle`, which simulates repeated digging and dumping at one
/// place.
Rig cycle_rig();

}  // namespace navvy::lab
