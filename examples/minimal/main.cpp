// SPDX-License-Identifier: Apache-2.0
// The smallest client of the library: loads a scene, moves one joint by its input, steps, and reads
// the joint by its handle.
#include <cstdio>
#include <exception>
#include <string>

#include "control/step_kinds.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "sim/world.h"

int main(int argc, char** argv) {
  try {
    navvy::device::Device device;
    navvy::sim::World world(
        navvy::scene_io::load_scene(argc > 1 ? argv[1] : SCENE, navvy::control::step_kinds()),
        device);
    const std::string machine = world.description().machines.at(0).name;
    const int boom_speed = world.inputs().index(machine + "/boom_joint/velocity");
    const navvy::sim::JointHandle boom = world.machines().at(machine).joint("boom_joint");

    // Raise the boom at 0.2 rad/s for a quarter of a second; this loop is the only operator in the
    // world.
    const double before = boom.position();
    while (world.time() < 0.25) {
      world.inputs().set(boom_speed, 0.2);
      world.step();
    }
    std::printf("on %s: boom from %.4f to %.4f rad in %.3f s, %d outputs, state %s\n",
                device.info().name.c_str(), before, boom.position(), world.time(),
                static_cast<int>(world.outputs().size()), world.hashes().state().c_str());
    return boom.position() > before ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
