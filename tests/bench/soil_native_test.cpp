// SPDX-License-Identifier: Apache-2.0
// Compares the native loop of src/bench/native with the double-precision twin, so that benches
// measure checked code.
#include "bench/native/native_soil.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/random.h"
#include "soil/particles/floor.h"
#include "soil/reference/reference_solver.h"

namespace navvy::bench {
namespace {

constexpr double kCell = 0.1, kGround = 40;

scene::Soil loam() {
  scene::Soil soil;
  soil.name = "loam";
  soil.bank_density = 1600;
  soil.friction_angle = radians(28);
  soil.cohesion = 5000;
  soil.residual_cohesion = 1000;
  soil.swell = 1.2;
  return soil;
}

/// Returns a lump on the ground, two particles per cell along each axis, displaced, in motion and
/// under stress.
std::vector<soil::Particle> lump(int nx, int ny, int nz) {
  Random random(5);
  std::vector<soil::Particle> out;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const double at[3] = {30.25 + 0.5 * i, 50.25 + 0.5 * j, kGround + 0.25 + 0.5 * k};
        soil::Particle p;
        for (std::size_t a = 0; a < 3; ++a) {
          const double x = at[a] + random.uniform(-0.2, 0.2);
          p.block[a] = static_cast<int>(std::floor(x / soil::kBlockCells));
          p.x[a] = static_cast<float>(x - soil::kBlockCells * p.block[a]);
          p.v[a] = static_cast<float>(random.uniform(-0.5, 0.5) + (a == 0 ? 3 : 0));
        }
        for (float& c : p.c) c = static_cast<float>(random.uniform(-3, 3));
        for (int a = 3; a < 6; ++a) p.s[a] = static_cast<float>(random.uniform(-2000, 2000));
        p.j = static_cast<float>(random.uniform(0.97, 1.03));
        p.mass = static_cast<std::int32_t>(mass_units(1600 * kCell * kCell * kCell / 8));
        p.id = static_cast<std::uint32_t>(out.size());
        out.push_back(p);
      }
  return out;
}

soil::reference::ReferenceSolver twin_of(const std::vector<soil::Particle>& start) {
  soil::reference::ReferenceSolver twin({loam()}, kCell, Vec3(0, 0, -kGravity),
                                        [](int, int) { return kGround; });
  for (const soil::Particle& p : start) twin.points.push_back(soil::reference::from_particle(p));
  return twin;
}

struct Worst {
  double x = 0, v = 0, s = 0, j = 0;
};

Worst compare(const NativeSoil& native, const soil::reference::ReferenceSolver& twin) {
  const auto got = native.particles();
  EXPECT_EQ(got.size(), twin.points.size());
  Worst out;
  for (std::size_t i = 0; i < got.size(); ++i) {
    const soil::reference::Point p = soil::reference::from_particle(got[i]), &q = twin.points[i];
    out.x = std::max(out.x, (p.x - q.x).cwiseAbs().maxCoeff());
    out.v = std::max(out.v, (p.v - q.v).cwiseAbs().maxCoeff());
    out.j = std::max(out.j, std::abs(p.j - q.j));
    for (std::size_t k = 0; k < 6; ++k) out.s = std::max(out.s, std::abs(p.s[k] - q.s[k]));
  }
  return out;
}

TEST(NativeLoop, AgreesWithTheDoubleTwinOnTheGround) {
  const auto start = lump(9, 7, 8);
  NativeSoil native(loam(), kCell, kGround);
  native.insert(start);
  auto twin = twin_of(start);
  for (int i = 0; i < 6; ++i) {
    native.step(1.5e-3);
    twin.step(1.5e-3);
  }
  const Worst worst = compare(native, twin);
  std::printf("[ VALUE    ] native loop against double twin after 6 steps: %.2g cells\n", worst.x);
  // Same bounds as for the kernels (SoilSolver.AgreesWithTheDoubleTwin).
  EXPECT_LT(worst.x, 2e-5);
  EXPECT_LT(worst.v, 2e-3);
  EXPECT_LT(worst.s, 20);
  EXPECT_LT(worst.j, 1e-5);
}

TEST(NativeLoop, SortingOnlyChangesTheOrderOfSums) {
  // Long enough for several sorts. The twin keeps the blocks of the start, so only the mean fall is
  // compared.
  const auto start = lump(10, 10, 10);
  NativeSoil native(loam(), kCell, kGround);
  native.insert(start);
  auto twin = twin_of(start);
  for (int i = 0; i < 60; ++i) {
    native.step(1.5e-3);
    twin.step(1.5e-3);
  }
  EXPECT_GT(native.sorts(), 2);
  Vec3 mean = Vec3::Zero(), expected = Vec3::Zero();
  for (const soil::Particle& p : native.particles())
    mean += soil::reference::from_particle(p).x / 1000;
  for (const auto& p : twin.points) expected += p.x / 1000;
  std::printf(
      "[ VALUE    ] native loop against double twin after 60 steps, mean position: %.2g cells\n",
      (mean - expected).norm());
  // Blocks decide with which neighbours a particle's opening is mixed, and they differ after a
  // sort.
  EXPECT_LT((mean - expected).norm(), 2e-4);
}

}  // namespace
}  // namespace navvy::bench
