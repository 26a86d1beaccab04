// SPDX-License-Identifier: Apache-2.0
// Runs every kernel of the soil on a handful of particles, few enough for a simulator of OpenCL
// devices that checks each access (`./dev sanitize kernels`): `navvy_kernels [STEPS]` throws two
// soils against a plate and prints the result; `navvy_kernels broken` reads one value behind a
// buffer, to verify that the simulator reports it.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "device/buffer.h"
#include "device/device.h"
#include "device/kernel_program.h"
#include "lab/lab_site.h"
#include "lab/rig_shapes.h"
#include "lab/soils.h"

namespace {

using namespace navvy;

/// Adds two cells cubed of a soil that flies at the plate.
void throw_soil(lab::Site& site, const Vec3& low, double speed, int soil) {
  auto particles = site.fill({low, low + Vec3::Constant(2 * site.cell())}, {}, soil);
  for (soil::Particle& p : particles) p.v[0] = static_cast<float>(speed);
  site.solver().insert(particles);
}

/// Runs a site of two metres with cells of 0.2 m. Soil that crosses its border in flight leaves it,
/// so that particles are sorted both ways; dilating soil uses the longer law.
bool dig(int steps, bool dilating) {
  device::Device device;
  std::vector<scene::Soil> soils(2, lab::clean_sand(33));
  soils[1].name = "clay";
  if (dilating) soils[1].cohesion = 5000;
  if (dilating) soils[1].dilatancy_angle = 0.1;
  if (dilating) soils[1].swell = 1.2;
  lab::SiteOptions options;
  options.size = 2;
  options.corner = Vec2::Zero();
  options.depth = 0.6;
  lab::Site site(device, soils, 0.2, options);
  site.add_tool(lab::blade(0.6, 0.5), make_pose(1.45, 0.8, 0));
  throw_soil(site, Vec3(1.0, 0.6, 0), 6, 0);
  throw_soil(site, Vec3(1.6, 1.4, 0.2), 12, 1);
  for (int i = 0; i < steps; ++i) site.step(site.step_limit());
  const soil::SolverStats& stats = site.solver().stats();
  const std::int64_t open = site.solver().ledger().error(),
                     left = site.solver().ledger().left_site.at(1);
  std::printf(
      "%s: %d particles in %d blocks, %llu steps, %llu re-bins, %lld units left the site, ledger "
      "open by %lld, state "
      "%s\n",
      dilating ? "cohesive sand that dilates" : "sand", stats.particles, stats.blocks,
      static_cast<unsigned long long>(stats.steps), static_cast<unsigned long long>(stats.rebins),
      static_cast<long long>(left), static_cast<long long>(open), site.digest().c_str());
  std::fflush(stdout);
  return open == 0 && stats.rebins > 0;
}

void read_behind() {
  device::Device device;
  const auto program = device::KernelProgram::from_text(
      device, "behind",
      "kernel void behind(global const int* in, global int* out) { out[0] = in[4]; }");
  device::Kernel kernel(program, "behind");
  const device::Buffer<int> in(device, std::vector<int>(4, 1));
  device::Buffer<int> out(device, 4);
  kernel.args(in, out).enqueue_groups(1);
  std::printf("read behind a buffer: %d\n", out.read()[0]);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::string word = argc > 1 ? argv[1] : "12";
    if (word == "broken") {
      read_behind();
      return 0;
    }
    const int steps = std::atoi(word.c_str());
    return dig(steps, false) && dig(steps, true) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
