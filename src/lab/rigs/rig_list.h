// SPDX-License-Identifier: Apache-2.0
// One function per rig; each returns the description of its rig. To add a rig, put a file into this
// folder, a line into this header and a line into rigs.cpp. The command line, its help and the
// parameter checks follow from the description.
#pragma once

#include "lab/rig.h"

namespace navvy::lab {

// `navvy lab RIG --help` prints what each rig does, its parameters and examples.

// Rigs without tools.
/// Returns the description of the rig `rest`: level ground at rest, whose vertical and horizontal
/// stresses are measured.
Rig rest_rig();
/// Returns the description of the rig `column`: the collapse of a released plane or round column of
/// sand.
Rig column_rig();
/// Returns the description of the rig `pour`: the angle of repose of a poured heap, and the creep
/// of that heap.
Rig pour_rig();
/// Returns the description of the rig `cone`: heaps that are built at a given angle: one must
/// stand, a steeper one must slide.
Rig cone_rig();
/// Returns the description of the rig `slope`: a long slope of sand: the angles at which it starts
/// and stops to flow.
Rig slope_rig();
/// Returns the description of the rig `slide`: a block that slides on a plane with Coulomb
/// friction.
Rig slide_rig();
/// Returns the description of the rig `throw`: soil that is thrown apart in a bin and must settle
/// to its former volume.
Rig throw_rig();
/// Returns the description of the rig `swell`: bank soil that is dumped from a bucket: heap volume
/// divided by bank volume.
Rig swell_rig();
/// Returns the description of the rig `shear`: the shear of a soil sample in plane strain.
Rig shear_rig();
/// Returns the description of the rig `triaxial`: triaxial compression and extension of a soil
/// sample.
Rig triaxial_rig();

// Rigs with tools.
/// Returns the description of the rig `blade`: a flat blade that is pushed through the ground.
Rig blade_rig();
/// Returns the description of the rig `wall`: the active and passive earth pressure on a retaining
/// wall.
Rig wall_rig();
/// Returns the description of the rig `footing`: the bearing capacity of a strip footing on
/// weightless soil.
Rig footing_rig();
/// Returns the description of the rig `plate`: a plate that is pressed into the ground: pressure as
/// a function of sinkage.
Rig plate_rig();
/// Returns the description of the rig `wheel`: one wheel at a prescribed slip: drawbar pull,
/// sinkage and torque.
Rig wheel_rig();
/// Returns the description of the rig `cut`: a vertical cut in cohesive soil: the height at which
/// it stands.
Rig cut_rig();
/// Returns the description of the rig `shear-box`: a direct shear test in a shear box.
Rig shear_box_rig();
/// Returns the description of the rig `hold`: a bucket held still, which must carry the weight of
/// its load.
Rig hold_rig();
/// Returns the description of the rig `light-tool`: a plate lighter than the soil it falls on,
/// which must not gain energy.
Rig light_tool_rig();
/// Returns the description of the rig `stand`: a body that stands on the ground: how far it sinks,
/// and whether it stops.
Rig stand_rig();
/// Returns the description of the rig `bucket`: a bucket that is filled along a path: force and
/// load.
Rig bucket_rig();
/// Returns the description of the rig `scrape`: a bucket that is pressed flat on level ground and
/// dragged.
Rig scrape_rig();
/// Returns the description of the rig `cycle`: repeated digging and dumping at one place: volume
/// per pass and mass ledger.
Rig cycle_rig();

}  // namespace navvy::lab
