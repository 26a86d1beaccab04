// SPDX-License-Identifier: Apache-2.0
// Maps of large sites: `site_bench [EDGE [RUNS]]`. Procedural hills of EDGE m (1000) in columns of
// 0.1 m, on the host only: a first export, a second one, one from a map file of as many cells, and
// an update after a bucket there and on 100 m.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench.h"
#include "core/error.h"
#include "formats/formats.h"
#include "heightfield/make_ground.h"
#include "map/map_sources.h"
#include "map/update_feed.h"

namespace {

using namespace navvy;
namespace fs = std::filesystem;

scene::Scene hills(double edge) {
  scene::Scene out;
  out.soils.resize(1);
  out.soils[0].name = "sand";
  out.ground.layers = {{"sand", 4}};
  out.ground.size = Vec2(edge, edge);
  out.solver.cell = 0.1;
  scene::GroundFeature feature;
  feature.kind = scene::GroundFeature::Kind::kHills;
  feature.height = 4;
  feature.length = 60;
  feature.seed = 3;
  out.ground.features = {feature};
  return out;
}

/// Measures one row of `runs` times `work`, and the peak memory of this program so far.
void measure(const std::string& name, double edge, int runs,
             const std::function<std::uint64_t()>& work) {
  bench::Row row;
  row.bench = name;
  row.site = edge;
  row.steps = 1;
  row.timing = bench::measure(
      runs, [] {}, [&] { row.particles = work(); });
  bench::print_host(row);
  struct rusage usage {};
  ::getrusage(RUSAGE_SELF, &usage);
  std::fprintf(stderr, "%s at %g m: %.1f s, %.1f s of processor, at most %ld MiB so far\n",
               name.c_str(), edge, row.timing.best, row.timing.processor, usage.ru_maxrss / 1024);
}

std::uint64_t export_elevation(const scene::Scene& scene, const heightfield::Ground& site,
                               const std::string& file) {
  const map::TerrainMap map =
      map::map_of_site(site, map::options_for(scene, site, {map::MapLayer::kElevation}));
  formats::format_named("geotiff").write(map, {map::MapLayer::kElevation}, file);
  return static_cast<std::uint64_t>(map.rect().area());
}

/// Measures an update of all layers after each of 20 buckets along a line through every tile.
void measure_updates(double edge, int runs) {
  const scene::Scene scene = hills(edge);
  heightfield::Ground ground = heightfield::make_ground(scene);
  map::UpdateFeed feed(map::options_for(scene, ground, map::default_layers()));
  feed.publish(ground.view());
  int bucket = 0;
  std::vector<heightfield::SoilLayer> taken;
  measure("map:update", edge, runs, [&] {
    constexpr std::uint64_t kBuckets = 20;
    for (std::uint64_t k = 0; k < kBuckets; ++k, ++bucket) {
      const int x0 = (7 * bucket) % (ground.nx() - 12), y0 = (5 * bucket) % (ground.ny() - 10);
      for (int iy = y0; iy < y0 + 10; ++iy)
        for (int ix = x0; ix < x0 + 12; ++ix)
          ground.take_above(ix, iy, ground.height(ix, iy) - 0.2, taken);
      feed.publish(ground.view(bucket));
    }
    return kBuckets;
  });
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const double edge = argc > 1 ? std::atof(argv[1]) : 1000;
    const int runs = argc > 2 ? std::atoi(argv[2]) : 2;
    if (!(edge >= 10) || runs < 1 || argc > 3) {
      std::fprintf(stderr,
                   "usage: site_bench [EDGE [RUNS]]   EDGE of the site in m (1000), at least 10\n");
      return 2;
    }
    const fs::path folder =
        fs::temp_directory_path() / ("navvy_site_bench_" + std::to_string(std::clock()));
    fs::create_directories(folder);
    const scene::Scene scene = hills(edge);
    measure("map:first_export", edge, runs, [&] {
      return export_elevation(scene, heightfield::make_ground(scene), folder / "site.tif");
    });
    const heightfield::Ground ground = heightfield::make_ground(scene);
    measure("map:export", edge, runs,
            [&] { return export_elevation(scene, ground, folder / "site.tif"); });
    // The written map has a cell for each column.
    scene::Scene on_map = scene;
    on_map.ground.features.clear();
    on_map.ground.file = folder / "site.tif";
    measure("map:first_export_of_file", edge, runs, [&] {
      return export_elevation(on_map, heightfield::make_ground(on_map), folder / "again.tif");
    });
    measure_updates(100, runs);
    measure_updates(edge, runs);
    fs::remove_all(folder);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "site_bench: %s\n", error.what());
    return 1;
  }
}
