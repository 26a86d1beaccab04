// SPDX-License-Identifier: Apache-2.0
// Runs worlds in parallel, each in its own thread with its own device: `navvy_worlds SCENE SECONDS
// [SCENE SECONDS]...` runs each for this simulated time and prints its name, steps and state hash.
// For builds under ThreadSanitizer and AddressSanitizer.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "control/step_kinds.h"
#include "device/device.h"
#include "scene_io/loader.h"
#include "session/session.h"

namespace {

using namespace navvy;

struct Run {
  std::string file;
  double seconds = 0;
  /// Line to print.
  std::string line;
  bool failed = false;
};

void run(Run& one) {
  try {
    // Everything happens in this thread: loading must be independent of the others, too.
    scene::Scene scene = scene_io::load_scene(one.file, control::step_kinds());
    const std::string name = scene.name;
    device::Device device("cpu");
    session::Session session(std::move(scene), device);
    while (session.world().time() < one.seconds && !session.done()) session.step();
    one.line =
        name + " " + std::to_string(session.world().steps()) + " steps " + session.state_hash();
  } catch (const std::exception& error) {
    one.line = one.file + ": " + error.what();
    one.failed = true;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(stderr, "usage: %s SCENE SECONDS [SCENE SECONDS]...\n", argv[0]);
    return 2;
  }
  std::vector<Run> runs;
  for (int i = 1; i + 1 < argc; i += 2)
    runs.push_back({argv[i], std::atof(argv[i + 1]), "", false});
  std::vector<std::thread> threads;
  threads.reserve(runs.size());
  for (Run& one : runs) threads.emplace_back(run, std::ref(one));
  for (std::thread& thread : threads) thread.join();
  bool failed = false;
  for (const Run& one : runs) {
    std::printf("%s\n", one.line.c_str());
    failed = failed || one.failed;
  }
  return failed ? 1 : 0;
}
