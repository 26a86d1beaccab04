// SPDX-License-Identifier: Apache-2.0
// Takes bytes as the output of a controller: every line is obeyed or answered, until the bytes end.
// Then the world steps once with the inputs that were set. One simulation serves all inputs; it
// returns to its start after each input that set something.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "control/step_kinds.h"
#include "core/error.h"
#include "link/control_stdio.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "target.h"

namespace {

using namespace navvy;

const char* const kScene =
    R"(<sdf version="1.9" xmlns:navvy="navvy"><world name="w"><navvy:soil name="s"/>
<navvy:ground><size_m>4 4</size_m><depth_m>0.5</depth_m></navvy:ground>
<navvy:solver><cell_m>0.5</cell_m><max_particles>1000</max_particles></navvy:solver>
<model name="m"><static>true</static><link name="a"/><link name="b"><pose>0 0 1 0 0 0</pose>
<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz></axis></joint>
<navvy:program><wait><duration_s>1</duration_s></wait></navvy:program></model></world></sdf>)";

struct Driven {
  run::Simulation simulation{
      scene_io::load_scene_from_string(kScene, "fuzz/scene.sdf", control::step_kinds())};
  int input = ::memfd_create("input", 0);

  Driven() {
    // Replaces standard input, and discards the answers.
    ::dup2(input, STDIN_FILENO);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, STDOUT_FILENO);
    ::close(nowhere);
  }
};

/// Returns the session, which is never destroyed: threads of the driver would outlive it.
Driven& the_one() {
  static Driven& driven = *new Driven;
  return driven;
}

}  // namespace

/// Compiles the kernels before the first input, since an empty cache would cost that input a
/// minute.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  the_one();
  return 0;
}

NAVVY_FUZZ_TARGET(control) {
  Driven& driven = the_one();
  fuzz::hold(::ftruncate(STDIN_FILENO, 0) == 0);
  fuzz::hold(::pwrite(STDIN_FILENO, data, size, 0) == static_cast<ssize_t>(size));
  fuzz::hold(::lseek(STDIN_FILENO, 0, SEEK_SET) == 0);
  link::ControlStdio controller(
      driven.simulation, 1, [] { return false; }, link::ControlServices{false, false});
  while (controller.exchange()) {
  }
  // Only a line that names inputs changes the session; the others cost no step.
  if (std::string(reinterpret_cast<const char*>(data), size).find("inputs") == std::string::npos)
    return 0;
  try {
    driven.simulation.step();
  } catch (const Error&) {
    // E.g. a joint that was commanded to 1e300.
  }
  driven.simulation.reset();
  return 0;
}
