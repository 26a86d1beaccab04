// SPDX-License-Identifier: Apache-2.0
// `./dev soak HOURS`. Status: 0 all claims hold, 1 a claim is violated or the run failed, 2 usage,
// 130 stopped before the end.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "core/stopwatch.h"
#include "soak/scooping.h"
#include "soak/soak.h"

namespace {

volatile std::sig_atomic_t asked = 0;

int run(const char* folder, double hours) {
  using namespace navvy;
  soak::Plan plan;
  plan.folder = folder;
  plan.cycles = 4 * std::max(1L, std::lround(hours * 3600 / soak::kCycle / 4));
  plan.stop = [] { return asked != 0; };
  const Stopwatch watch;
  plan.after_cycle = [&, shown = 0.0](long cycle) mutable {
    if (watch.seconds() - shown < 60) return;
    shown = watch.seconds();
    std::printf("%.3f h simulated\n", static_cast<double>(cycle) * soak::kCycle / 3600);
    std::fflush(stdout);
  };
  device::Device device;
  const soak::Result result = soak::soak(device, plan);
  std::printf("%s", soak::summary(result, plan).c_str());
  if (!result.broken.empty()) return 1;
  return result.compared < plan.cycles ? 130 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const double hours = argc == 3 ? std::atof(argv[2]) : 0;
  if (!(hours > 0 && hours <= 250)) {  // the scene's longest time is 1e6 s
    std::printf(
        "usage: navvy_soak FOLDER HOURS: simulated, up to 250; continues the "
        "folder\n");
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, [](int) { asked = 1; });
  try {
    return run(argv[1], hours);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
