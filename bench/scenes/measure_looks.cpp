// SPDX-License-Identifier: Apache-2.0
// Time and seams of pictures of a snapshot's soil, and pictures to inspect:
// `measure_looks SCENE SNAPSHOT [FOLDER for PNG files]`.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "control/step_kinds.h"
#include "render/renderer.h"
#include "run/simulation.h"
#include "scene_io/loader.h"
#include "scene_io/shipped.h"
#include "sim/frame_builder.h"

namespace {

using namespace navvy;

// Lengths in the picture along which seams are measured [pixels].
constexpr int kAcross = 28, kOutside = 40;
// Columns inside and outside of an edge that must be free of cuts, and of other edges outside.
constexpr int kInside = 2, kBeyond = 5;
constexpr std::array<const char*, 2> kCameraNames = {"from_se", "from_nw"};
// Cut or fill that counts as one, and step between neighbours that counts as a wall [m].
constexpr double kCut = 0.03, kWall = 0.06;

/// Returns the column and row of a point of W in the picture of `camera`.
Vec2 project(const scene::FrameCamera& camera, const Vec3& p_W) {
  const Vec3 c = camera.X_WC.inverse() * p_W;
  const double scale = 0.5 * camera.width / std::tan(0.5 * camera.fov);
  return {0.5 * camera.width + scale * c.x() / -c.z(),
          0.5 * camera.height - scale * c.y() / -c.z()};
}

// Machines and their shadows move, and only soil is compared.
void remove_machines(scene::Frame& frame) {
  frame.shapes.clear();
  frame.cylinders.clear();
}

double luminance(const std::uint8_t* p) { return 0.3 * p[0] + 0.59 * p[1] + 0.11 * p[2]; }

/// A place on the border of the active soil, between two columns.
struct Edge {
  Vec3 p_W;  ///< middle of the side that the two columns share
  Vec3 out;  ///< unit vector in W across it, away from the active soil
};

/// The ground of a frame by column.
struct Columns {
  const scene::FrameGround& ground;

  std::size_t index(const Vec2i& c) const {
    return static_cast<std::size_t>(c.y()) * static_cast<std::size_t>(ground.nx) +
           static_cast<std::size_t>(c.x());
  }
  bool holds(const Vec2i& c) const {
    return c.x() >= 0 && c.y() >= 0 && c.x() < ground.nx && c.y() < ground.ny;
  }
  bool active(const Vec2i& c) const {
    return std::abs(ground.top[index(c)] - ground.height[index(c)]) > 1e-4f;
  }
  double top(const Vec2i& c) const { return ground.top[index(c)]; }
  /// Returns the height of the soil above that at the start of the run [m].
  double filled(const Vec2i& c) const {
    const std::size_t i = index(c);
    return ground.change[i] + ground.top[i] - ground.height[i];
  }
  /// Returns whether an edge leaves column `c` along `step` with neither a cut nor another edge
  /// near.
  bool edge(const Vec2i& c, const Vec2i& step) const {
    if (!holds(c - kInside * step) || !holds(c + kBeyond * step)) return false;
    double low = 1e9, high = -1e9;
    for (int k = -kInside; k <= kBeyond; ++k) {
      const Vec2i at = c + k * step;
      if (active(at) != (k <= 0)) return false;
      low = std::min(low, filled(at));
      high = std::max(high, filled(at));
      if (k > -kInside && std::abs(top(at) - top(at - step)) > kWall) return false;
    }
    return high - low < kCut;
  }
};

/// Returns all edges of the active soil away from cuts.
std::vector<Edge> edges_of(const scene::FrameGround& ground) {
  const Columns columns{ground};
  std::vector<Edge> out;
  for (int y = 0; y < ground.ny; ++y)
    for (int x = 0; x < ground.nx; ++x)
      for (const Vec2i& step : {Vec2i(1, 0), Vec2i(-1, 0), Vec2i(0, 1), Vec2i(0, -1)}) {
        const Vec2i c(x, y);
        if (!columns.active(c) || !columns.edge(c, step)) continue;
        const Vec2 side =
            ground.origin + ground.cell * (Vec2(x, y) + Vec2(0.5, 0.5) + 0.5 * step.cast<double>());
        out.push_back({Vec3(side.x(), side.y(), 0.5 * (columns.top(c) + columns.top(c + step))),
                       Vec3(step.x(), step.y(), 0)});
      }
  return out;
}

/// Luminance along lines across edges of one direction.
struct Profile {
  double range = 0;                                        ///< sum of the ranges of the lines
  std::vector<double> sum = std::vector<double>(kAcross);  ///< sum of the lines
  int lines = 0;

  void add(const render::Image& image, const Vec2& middle, const Vec2& along) {
    double low = 1e9, high = -1e9;
    for (int k = 0; k < kAcross; ++k) {
      const Vec2 p = middle + (k + 0.5 - 0.5 * kAcross) * along;
      const double value = luminance(image.pixel(static_cast<int>(p.x()), static_cast<int>(p.y())));
      sum[static_cast<std::size_t>(k)] += value;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    range += high - low;
    ++lines;
  }
  /// Returns the range of the mean line.
  double mean_range() const {
    return (*std::max_element(sum.begin(), sum.end()) - *std::min_element(sum.begin(), sum.end())) /
           lines;
  }
};

/// Prints the range of luminance across the edges that a picture shows, beside that outside.
void measure_seams(render::Renderer& renderer, const scene::Frame& frame,
                   const scene::FrameCamera& camera, const char* name) {
  render::DepthImage depth;
  renderer.render(frame, camera, &depth);
  const render::Image image = renderer.render(frame, camera);
  const auto shown = [&](const Vec2& p, double far) {
    return p.x() > 1 && p.y() > 1 && p.x() < camera.width - 1 && p.y() < camera.height - 1 &&
           std::abs(depth.at(static_cast<int>(p.x()), static_cast<int>(p.y())) - far) < 0.25;
  };
  // By direction: east, west, north, south.
  std::array<Profile, 4> on, beside;
  for (const Edge& edge : edges_of(frame.ground)) {
    const Vec2 middle = project(camera, edge.p_W),
               step = project(camera, edge.p_W + 0.1 * edge.out) - middle;
    // Less than 5 pixels for 0.1 m would measure more than the columns that are free of cuts.
    if (step.norm() < 5) continue;
    const Vec2 along = step.normalized(), other = middle + kOutside * along;
    const double far = -(camera.X_WC.inverse() * edge.p_W).z();
    if (!shown(middle - 0.5 * kAcross * along, far) || !shown(middle, far) ||
        !shown(other + 0.5 * kAcross * along, far))
      continue;
    const std::size_t k =
        edge.out.x() != 0 ? (edge.out.x() > 0 ? 0 : 1) : (edge.out.y() > 0 ? 2 : 3);
    on[k].add(image, middle, along);
    beside[k].add(image, other, along);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    if (on[k].lines < 8) continue;
    std::printf(
        "seam %-8s %-5s %4d lines: range %5.1f, outside %5.1f, ratio %.2f (wanted: 1.3); of the "
        "mean line %4.1f, outside %4.1f\n",
        name, std::array{"east", "west", "north", "south"}[k], on[k].lines,
        on[k].range / on[k].lines, beside[k].range / beside[k].lines, on[k].range / beside[k].range,
        on[k].mean_range(), beside[k].mean_range());
  }
}

/// Returns the middle of the active soil that rests on the ground.
Vec3 middle_of(const scene::FrameGround& ground) {
  const Columns columns{ground};
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (int y = 0; y < ground.ny; ++y)
    for (int x = 0; x < ground.nx; ++x)
      if (columns.active({x, y})) {
        sum += Vec3(x + 0.5, y + 0.5, columns.top({x, y}));
        ++count;
      }
  sum /= std::max(count, 1.0);
  return {ground.origin.x() + ground.cell * sum.x(), ground.origin.y() + ground.cell * sum.y(),
          sum.z()};
}

/// Returns a camera 7 m from `target`, 35 degrees above it, at the heading `yaw` [rad].
scene::FrameCamera look_at(const Vec3& target, double yaw) {
  const Vec3 back(std::cos(radians(35)) * std::cos(yaw), std::cos(radians(35)) * std::sin(yaw),
                  std::sin(radians(35)));
  const Vec3 right = Vec3::UnitZ().cross(back).normalized();
  scene::FrameCamera out;
  out.X_WC.linear() << right, back.cross(right), back;
  out.X_WC.translation() = target + 7 * back;
  return out;
}

/// Prints the share of pixels that look alike in two pictures, of all and of those that differ.
void compare(const render::Image& before, const render::Image& after, const char* name) {
  double other = 0, changed = 0, most = 0;
  for (std::size_t i = 0; i < before.rgb.size(); i += 3) {
    const double step = std::abs(luminance(&before.rgb[i]) - luminance(&after.rgb[i]));
    changed += step > 0 ? 1 : 0;
    other += step > 4 ? 1 : 0;
    most = std::max(most, step);
  }
  const double pixels = static_cast<double>(before.rgb.size()) / 3;
  std::printf(
      "rest %-8s within 4 grey levels: %.2f %% of the pixels (wanted: 99 %%), %.1f %% of the %.0f "
      "that change; most %.0f\n",
      name, 100 * (1 - other / pixels), 100 * (1 - other / std::max(changed, 1.0)), changed, most);
}

/// Prints the time of a picture and of its surface of loose soil.
void measure_time(render::Renderer& renderer, scene::Frame& frame, scene::FrameCamera camera) {
  camera.samples = 1;
  double soil_ms = 1e9, processor = 1e9, prepare = 1e9;
  for (int i = 0; i < 15; ++i) {
    // As after a dug bucket: 2 m x 2 m of the ground are lit anew.
    frame.ground.changed = {{frame.ground.nx / 2, frame.ground.ny / 2, frame.ground.nx / 2 + 20,
                             frame.ground.ny / 2 + 20}};
    ++frame.ground.revision;
    const double start = bench::processor_seconds();
    renderer.render(frame, camera);
    processor = std::min(processor, 1e3 * (bench::processor_seconds() - start));
    soil_ms = std::min(soil_ms, renderer.stats().soil_ms);
    prepare = std::min(prepare, renderer.stats().prepare_ms);
  }
  const double particles = static_cast<double>(frame.particles.position.size()) / 3;
  std::printf(
      "time: %.0f particles, surface %.2f ms, %.2f ms per 10 000 (wanted: 3); a picture of %d x %d "
      "%.1f ms of processor (wanted: 40), %.1f ms before drawing; %d triangles of soil, %d lumps\n",
      particles, soil_ms, 1e4 * soil_ms / std::max(particles, 1.0), camera.width, camera.height,
      processor, prepare, renderer.stats().soil_triangles, renderer.stats().particles_drawn);
}

/// Prints how the pictures of `cameras` change in the step in which the next block comes to rest.
void measure_rest(run::Simulation& simulation, sim::FrameBuilder& frames,
                  render::Renderer& renderer, const std::array<scene::FrameCamera, 2>& cameras,
                  const std::string& folder) {
  constexpr double kLongest = 3;  // simulated time to wait for it [s]
  const std::uint64_t rested = simulation.world().soil().counts().deposited_blocks;
  const double end = simulation.time() + kLongest;
  scene::Frame before;
  while (simulation.world().soil().counts().deposited_blocks == rested) {
    if (simulation.time() > end) {
      std::printf("rest: no block came to rest within %.0f s\n", kLongest);
      return;
    }
    before = frames.build();
    simulation.step();
  }
  scene::Frame after = frames.build();
  for (scene::Frame* frame : {&before, &after}) remove_machines(*frame);
  std::printf("rest at %.3f s, from %zu to %zu particles\n", simulation.time(),
              before.particles.position.size() / 3, after.particles.position.size() / 3);
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    const render::Image one = renderer.render(before, cameras[k]),
                        other = renderer.render(after, cameras[k]);
    compare(one, other, kCameraNames[k]);
    if (folder.empty()) continue;
    const std::string stem =
        folder + "/" + simulation.world().description().name + "_" + kCameraNames[k] + "_";
    render::write_png(stem + "before.png", one);
    render::write_png(stem + "after.png", other);
  }
}

void measure(const std::string& scene_name, const std::string& snapshot,
             const std::string& folder) {
  const scene::Scene scene =
      scene_io::load_scene(scene_io::find_scene(scene_name), control::step_kinds());
  run::Simulation simulation(scene);
  simulation.load(snapshot, true);
  sim::FrameBuilder frames(simulation.world());
  scene::Frame frame = frames.build();
  render::Renderer renderer;
  if (!scene.cameras.empty()) {
    const scene::FrameCamera camera = frames.camera(scene.cameras.front());
    measure_time(renderer, frame, camera);
    if (!folder.empty())
      render::write_png(folder + "/" + scene.name + "_scene.png", renderer.render(frame, camera));
  }
  remove_machines(frame);
  const Vec3 middle = middle_of(frame.ground);
  const std::array<scene::FrameCamera, 2> cameras = {look_at(middle, radians(-50)),
                                                     look_at(middle, radians(130))};
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    measure_seams(renderer, frame, cameras[k], kCameraNames[k]);
    if (!folder.empty())
      render::write_png(folder + "/" + scene.name + "_" + kCameraNames[k] + ".png",
                        renderer.render(frame, cameras[k]));
  }
  measure_rest(simulation, frames, renderer, cameras, folder);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 3) {
      std::fprintf(stderr, "usage: measure_looks SCENE SNAPSHOT [FOLDER for PNG files]\n");
      return 2;
    }
    measure(argv[1], argv[2], argc > 3 ? argv[3] : "");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
