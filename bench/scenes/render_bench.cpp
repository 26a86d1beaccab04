// SPDX-License-Identifier: Apache-2.0
// Time of one picture, and pictures to inspect:
// `render_bench [folder for PNG files [samples per pixel]]`.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "bench.h"
#include "core/stopwatch.h"
#include "paths.h"
#include "render/renderer.h"
#include "trench_scene.h"

namespace {

using namespace navvy;

struct Row {
  const char* name;
  scene::FrameCamera camera;
};

constexpr int kPictures = 9;

/// Changes what a dig changes between pictures: the machine's pose, the soil particles, and the
/// ground around the bucket.
void move_on(scene::Frame& frame, int picture) {
  const double step = (picture & 1) != 0 ? 0.002 : -0.002;
  for (scene::FrameShape& shape : frame.shapes) shape.X_WV.translation().x() += step;
  for (scene::FrameCylinder& c : frame.cylinders) c.p_base.x() += step, c.p_rod.x() += step;
  for (std::size_t i = 0; i < frame.particles.position.size(); i += 3)
    frame.particles.position[i] += static_cast<float>(step);
  scene::FrameGround& g = frame.ground;
  const int x0 = static_cast<int>((3.5 - g.origin.x()) / g.cell),
            y0 = static_cast<int>((-1.0 - g.origin.y()) / g.cell);
  g.changed = {{x0, y0, x0 + 20, y0 + 20}};
  for (int y = y0; y < y0 + 20; ++y)
    for (int x = x0; x < x0 + 20; ++x)
      g.height[static_cast<std::size_t>(y) * static_cast<std::size_t>(g.nx) +
               static_cast<std::size_t>(x)] += static_cast<float>(step);
  ++g.revision;
}

// Measures the least and the median time of several pictures after two for warm-up. On a busy
// machine the processor time over all cores is meaningful and the wall time is not.
void measure(render::Renderer& renderer, scene::Frame& frame, const Row& row,
             const std::string& folder, const std::string& prefix) {
  const Stopwatch first;
  render::Image image = renderer.render(frame, row.camera);
  const double first_ms = 1e3 * first.seconds();
  std::vector<double> times;
  double cpu_ms = 1e30;
  for (int i = 0; i < kPictures; ++i) {
    move_on(frame, i);
    const std::clock_t start = std::clock();
    const Stopwatch watch;
    image = renderer.render(frame, row.camera);
    times.push_back(1e3 * watch.seconds());
    cpu_ms = std::min(cpu_ms, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::sort(times.begin(), times.end());
  const render::RenderStats& s = renderer.stats();
  std::printf(
      "%-10s %-9s %4d x %-4d columns  first %6.1f ms, least %6.1f, median %6.1f, processor %6.1f "
      "(prepare %5.1f, draw "
      "%5.1f)  "
      "%6d ground triangles in %3d tiles, %5d lumps, %6d triangles\n",
      prefix.c_str(), row.name, frame.ground.nx, frame.ground.ny, first_ms, times.front(),
      times[times.size() / 2], cpu_ms, s.prepare_ms, s.draw_ms, s.ground_triangles, s.ground_tiles,
      s.particles_drawn, s.particle_triangles);
  bench::Row result;
  result.bench = "render:" + prefix + "_" + row.name;
  result.device = "OSMesa, 1280 x 720";
  result.steps = 1;
  result.particles = static_cast<std::uint64_t>(s.particles_drawn);
  result.timing.best = times.front() / 1e3;
  result.timing.median = times[times.size() / 2] / 1e3;
  result.timing.spread = (times.back() - times.front()) / times.front();
  result.peak = bench::host_peak();
  bench::append_csv(result);
  if (!folder.empty()) render::write_png(folder + "/" + prefix + "_" + row.name + ".png", image);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "";
  const int samples = argc > 2 ? std::atoi(argv[2]) : 1;
  const std::string meshes = navvy::source_dir() + "/vehicles/ew180/meshes";
  std::vector<Row> rows = {{"side", render::look_from({6.5, -12.0, 4.6}, {1.6, 0.6, 1.55})},
                           {"front", render::look_from({11.5, -7.0, 4.6}, {2.2, 0.9, 1.3})},
                           {"close", render::look_from({7.6, -3.6, 2.6}, {4.4, 0.2, 0.5})},
                           {"rear", render::look_from({-10.5, 8.0, 5.4}, {0.8, 0.3, 1.5})},
                           {"high", render::look_from({30, -38, 22}, {0, 0, 0})}};
  for (Row& row : rows) row.camera.samples = samples;
  for (const int nx : {200, 1024}) {
    render::TrenchScene scene;
    render::make_trench_scene(scene, meshes, nx);
    render::Renderer renderer;
    for (const Row& row : rows)
      measure(renderer, scene.frame, row, folder, nx == 200 ? "trench" : "site");
  }
  // A heap of twenty thousand particles that fills the picture.
  render::TrenchScene heap;
  render::make_ground(heap.frame.ground, 200, 200, 0.1);
  render::add_soil(heap.frame.particles, {-1.4, -0.9, 0.0}, {1.4, 0.9, 0.5}, 0.1);
  std::printf("heap: %zu particles\n", heap.frame.particles.position.size() / 3);
  render::Renderer renderer;
  Row row{"heap", render::look_from({2.6, -2.6, 1.8}, {0, 0, 0.2})};
  row.camera.samples = samples;
  measure(renderer, heap.frame, row, folder, "particles");
  return 0;
}
