// SPDX-License-Identifier: Apache-2.0
// Descriptions of machines in URDF, which ROS programs read to draw and to plan.
#pragma once

#include <string>
#include <vector>

#include "formats/ros/machine_frames.h"
#include "scene/machine.h"

namespace navvy::formats::ros {

/// Returns the URDF description of a machine. `frames` holds the frames of machine_frames,
/// optionally followed by frames of sensors; each becomes a link of the URDF, and each joint has
/// the name that it has in the machine's file.
///
/// The frame of a link carries the link's mass, inertia, visuals and collisions. Joints have axes,
/// limits of position, velocity and effort, damping and friction; values that are unlimited in
/// Navvy become 1e9. A ball joint, which URDF lacks, is "floating". Meshes are referred to by
/// `file://` and their absolute path. A capsule is written as a cylinder and two spheres, a cone as
/// the cylinder around it, and a plane as a plate of 1 mm whose upper face is the plane. A mesh
/// that was made from numbers, such as that of a bucket, is in no file and is written as the box
/// around it.
///
/// @throws Error if a link has no frame.
std::string urdf(const scene::Machine& machine, const std::vector<MachineFrame>& frames);

}  // namespace navvy::formats::ros
