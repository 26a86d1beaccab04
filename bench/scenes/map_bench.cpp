// SPDX-License-Identifier: Apache-2.0
// Cost of maps for planners: `map_bench [NAME [SECONDS]]` runs the rows whose name contains NAME.
//
//   map_update:100m, :1km          the update of all layers after a dug bucket
//   map_full:100m, :1km            the whole map of the same ground, for comparison
//   map_ask:heights, :clearances   a million heights, 100 000 clearances, on one core
//   map_trench:whole, :publish, :wire
//                                  SECONDS simulated of `trench`, all layers published at 10 Hz
//                                  over TCP to a reader: time of the loop, of publishing, and from
//                                  a step's end to the reader
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "bench.h"
#include "control/step_kinds.h"
#include "core/error.h"
#include "core/random.h"
#include "core/stopwatch.h"
#include "device/device.h"
#include "heightfield/layered_ground.h"
#include "link/map_publisher.h"
#include "map/map_maker.h"
#include "map/map_queries.h"
#include "map/map_sources.h"
#include "map/update_feed.h"
#include "paths.h"
#include "planner/footprint.h"
#include "scene_io/loader.h"
#include "session/session.h"
#include "sim/timing.h"
#include "sim/world_terrain.h"

namespace {

using namespace navvy;

// Part of a row's name.
std::string wanted;

bool asked(const std::string& name) { return name.find(wanted) != std::string::npos; }

/// Returns the processor time of this thread alone [s].
double thread_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Returns a site of gentle hills, in columns of 0.1 m.
heightfield::GroundSetup hills(int columns) {
  heightfield::GroundSetup out;
  out.nx = out.ny = columns;
  out.cell = 0.1;
  out.datum = -4;
  out.soils.resize(1);
  out.soils[0].name = "loam";
  out.soils[0].bank_density = 1540;
  out.layers = {{"loam", 1}};
  out.surface = [](int ix, int iy) {
    return 0.3 * std::sin(0.011 * ix) + 0.2 * std::cos(0.007 * iy);
  };
  return out;
}

/// Columns of a bucket of 1 m x 1.1 m x 0.25 m.
constexpr int kBucketX = 10, kBucketY = 11;
void dig_bucket(heightfield::Ground& ground, int x0, int y0) {
  std::vector<heightfield::SoilLayer> taken;
  for (int iy = y0; iy < y0 + kBucketY; ++iy)
    for (int ix = x0; ix < x0 + kBucketX; ++ix)
      ground.take_above(ix, iy, ground.height(ix, iy) - 0.25, taken);
}

/// Reads every value of every layer, strip by strip: untouched ground is computed on demand.
void read_all(const map::TerrainMap& map) {
  double sum = 0;
  for (int iy = 0; iy < map.ny(); iy += map::LayerTiles::kSide) {
    const int end = std::min(map.ny(), iy + map::LayerTiles::kSide);
    for (const map::MapLayer layer : map::default_layers())
      sum += map.copy(layer, {0, iy, map.nx(), end}).back();
  }
  // Prevents the compiler from removing the reads.
  volatile double sink = sum;
  static_cast<void>(sink);
}

/// Compares one update with a full map of the same ground.
void measure_updates(const std::string& size, int columns) {
  const std::string update_name = "map_update:" + size, full_name = "map_full:" + size;
  if (!asked(update_name) && !asked(full_name)) return;
  heightfield::Ground ground(hills(columns));
  bench::Row full, update;
  full.bench = full_name;
  update.bench = update_name;
  full.site = update.site = columns * 0.1;
  full.steps = update.steps = 1;
  full.particles = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(columns);
  update.particles = kBucketX * kBucketY;
  Random random(5);
  double time = 0;
  const auto dig = [&] {
    dig_bucket(ground, static_cast<int>(random.uniform(0, columns - kBucketX)),
               static_cast<int>(random.uniform(0, columns - kBucketY)));
  };
  // A feed's first map is full and is read as a whole. The previous feed is destroyed first, so
  // that the large site needs memory for one only.
  std::optional<map::UpdateFeed> feed;
  full.timing = bench::measure(
      columns > 2000 ? 1 : 5,
      [&] {
        dig();
        feed.reset();
      },
      [&] {
        feed.emplace(map::MapOptions{});
        read_all(feed->publish(ground.view(time += 0.1))->map);
      });
  update.timing = bench::measure(21, dig, [&] { feed->publish(ground.view(time += 0.1)); });
  bench::print_host(full);
  bench::print_host(update);
  std::fprintf(stderr,
               "%s: an update takes %.3g ms (%.3g of processor), a full map %.3g ms (%.3g): %.0f "
               "times (%.0f)\n",
               size.c_str(), 1e3 * update.timing.median, 1e3 * update.timing.processor,
               1e3 * full.timing.best, 1e3 * full.timing.processor,
               full.timing.best / update.timing.median,
               full.timing.processor / update.timing.processor);
}

void measure_queries() {
  if (!asked("map_ask:heights") && !asked("map_ask:clearances")) return;
  heightfield::Ground ground(hills(400));
  map::MapMaker maker({});
  maker.update(ground.view(0));
  const map::TerrainMap map = maker.map();
  const planner::Footprint excavator{2.5, 2.5, 1.3, 1.3};
  double sum = 0;
  const auto ask = [&](const std::string& name, int count,
                       const std::function<double(Random&)>& question) {
    if (!asked(name)) return;
    bench::Row row;
    row.bench = name;
    row.particles = 1;
    row.steps = static_cast<std::uint64_t>(count);
    row.timing = bench::measure(
        5, [] {},
        [&] {
          Random random(9);
          for (int i = 0; i < count; ++i) sum += question(random);
        });
    bench::print_host(row);
    std::fprintf(stderr, "%s: %.3g a second, %.3g a second of processor\n", name.c_str(),
                 count / row.timing.best, count / row.timing.processor);
  };
  ask("map_ask:heights", 1000000, [&](Random& random) {
    return map::height(map, random.uniform(0, 40), random.uniform(0, 40));
  });
  ask("map_ask:clearances", 100000, [&](Random& random) {
    return planner::clearance(map, excavator, random.uniform(4, 36), random.uniform(4, 36),
                              random.uniform(-3, 3));
  });
  if (!std::isfinite(sum)) throw Error("map_bench: a query had no answer");
}

/// Reads patches as they come and records the arrival of the last byte of each.
class Reader {
 public:
  explicit Reader(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (socket_ < 0 ||
        ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw Error("map_bench: cannot connect to its own port");
    thread_ = std::thread([this] { follow(); });
  }
  ~Reader() { join(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  /// Returns when the stream has ended.
  void join() {
    if (!thread_.joinable()) return;
    thread_.join();
    ::close(socket_);
  }
  /// Returns sequence and arrival time of every patch, after `join`.
  const std::map<std::uint64_t, double>& arrivals() const { return arrivals_; }
  static double now() {
    std::timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

 private:
  bool take(std::size_t bytes, std::vector<char>& out) {
    out.resize(bytes);
    for (std::size_t at = 0; at < bytes;) {
      const ssize_t got = ::recv(socket_, out.data() + at, bytes - at, 0);
      if (got <= 0) return false;
      at += static_cast<std::size_t>(got);
    }
    return true;
  }
  /// Returns the number behind a key of the header.
  static double number(const std::string& head, const char* key) {
    const std::size_t at = head.find(std::string("\"") + key + "\": ");
    return at == std::string::npos ? 0 : std::atof(head.c_str() + at + std::strlen(key) + 4);
  }
  void follow() {
    std::vector<char> bytes;
    while (take(12, bytes)) {
      std::uint32_t length = 0;
      for (int i = 0; i < 4; ++i)
        length |= static_cast<std::uint32_t>(
                      static_cast<unsigned char>(bytes[static_cast<std::size_t>(8 + i)]))
                  << (8 * i);
      if (!take(length, bytes)) return;
      const std::string head(bytes.begin(), bytes.end());
      // Rectangles are the last item of the header: [[x0, y0, x1, y1], ...
      double columns = 0;
      std::size_t at = head.find("\"rects\": [");
      for (std::array<int, 4> r{}; at != std::string::npos; at = head.find('[', at + 1))
        if (std::sscanf(head.c_str() + at, "[%d, %d, %d, %d]", &r[0], &r[1], &r[2], &r[3]) == 4)
          columns += static_cast<double>(r[2] - r[0]) * (r[3] - r[1]);
      const auto layers = static_cast<double>(map::default_layers().size());
      if (!take(static_cast<std::size_t>(columns * layers * 4), bytes)) return;
      arrivals_[static_cast<std::uint64_t>(number(head, "sequence"))] = now();
    }
  }

  int socket_;
  std::map<std::uint64_t, double> arrivals_;
  std::thread thread_;
};

/// Measurements of a run that publishes its map.
struct TrenchRun {
  /// Wall time of each update [s], and processor time of all [s].
  std::vector<double> publishing;
  double spent = 0;
  /// End of the step of each update that had changes, by the update's number [s].
  std::map<std::uint64_t, double> step_ends;
  /// Columns over all updates.
  std::uint64_t changed = 0;
  /// Wall and processor time of the run [s].
  double whole = 0, processor = 0;
  std::uint64_t steps = 0;
  double simulated = 0;
  std::string hash;
};

/// Steps the session for `seconds` of simulated time and publishes the map ten times a second.
TrenchRun run_trench(session::Session& session, device::Device& device, map::UpdateFeed& feed,
                     double seconds) {
  constexpr double kRate = 10;
  TrenchRun run;
  const sim::World& world = session.world();
  // The whole map is sent before the run, as `navvy run --publish` does.
  std::uint64_t last =
      feed.publish(sim::terrain_view(world, heightfield::SurfaceKind::kMapped))->sequence;
  const double began = bench::processor_seconds();
  const Stopwatch whole;
  while (!session.done() && world.time() < seconds) {
    session.step();
    if (!sim::sample_due(world.steps(), world.dt(), kRate)) continue;
    const double end_of_step = Reader::now();
    const double before = thread_seconds();
    const Stopwatch watch;
    const map::UpdateFeed::Update update =
        feed.publish(sim::terrain_view(world, heightfield::SurfaceKind::kMapped));
    run.publishing.push_back(watch.seconds());
    run.spent += thread_seconds() - before;
    // Without changes, nothing is sent.
    if (update->sequence == last) continue;
    last = update->sequence;
    run.step_ends[last] = end_of_step;
    run.changed += static_cast<std::uint64_t>(update->changed);
  }
  device.finish();
  run.whole = whole.seconds();
  run.processor = bench::processor_seconds() - began;
  run.steps = world.steps();
  run.simulated = world.time();
  run.hash = session.state_hash();
  return run;
}

/// Returns the time from the end of each step to the arrival of its patch [s]. A late reader got
/// one patch for several updates; the patch of the last one counts for all of them.
std::vector<double> delays(const TrenchRun& run, const std::map<std::uint64_t, double>& arrivals) {
  std::vector<double> out;
  for (const auto& [sequence, end] : run.step_ends)
    if (const auto at = arrivals.lower_bound(sequence); at != arrivals.end())
      out.push_back(at->second - end);
  if (out.empty()) throw Error("map_bench: no patch arrived");
  return out;
}

void print_trench(const device::Device& device, const TrenchRun& run,
                  const std::vector<double>& late) {
  bench::Row all, publish, wire;
  all.bench = "map_trench:whole";
  all.timing.best = all.timing.median = run.whole;
  all.timing.processor = run.processor;
  all.steps = run.steps;
  all.simulated = run.simulated;
  all.hash = run.hash;
  all.timing.runs = 1;
  // The sum, to give a share of the whole.
  const double sum = std::accumulate(run.publishing.begin(), run.publishing.end(), 0.0);
  publish.bench = "map_trench:publish";
  publish.timing.best = publish.timing.median = sum;
  publish.timing.runs = 1;
  publish.timing.processor = run.spent;
  publish.steps = run.publishing.size();
  // Columns per update.
  publish.particles = run.step_ends.empty() ? 0 : run.changed / run.step_ends.size();
  publish.simulated = run.simulated;
  wire.bench = "map_trench:wire";
  wire.steps = late.size();
  wire.timing = bench::timing_of(late, {});
  for (const bench::Row& row : {all, publish, wire})
    if (asked(row.bench)) bench::print(device.info(), row);
  std::fprintf(stderr,
               "trench, %.3g s: publishing took %.3g s of %.4g s, %.2g %% (of processor %.3g s of "
               "%.4g s, %.2g %%); "
               "patches came %.3g ms after their step (median), %.3g ms at most, %zu of %zu\n",
               run.simulated, sum, run.whole, 100 * sum / run.whole, run.spent, run.processor,
               100 * run.spent / run.processor, 1e3 * wire.timing.median,
               1e3 * wire.timing.best * (1 + wire.timing.spread), late.size(),
               run.step_ends.size());
}

/// Measures a session that digs a trench and publishes its map to a reader over TCP.
void measure_trench(double seconds) {
  if (!asked("map_trench:whole") && !asked("map_trench:publish") && !asked("map_trench:wire"))
    return;
  device::Device device;
  session::Session session(
      scene_io::load_scene(navvy::source_dir() + "/scenarios/trench.sdf", control::step_kinds()),
      device);
  const sim::World& world = session.world();
  map::UpdateFeed feed(map::options_for(world.description(), world.ground(), map::default_layers(),
                                        session.design()));
  link::MapPublisher publisher(feed, "tcp:0", map::default_layers());
  Reader reader(publisher.port());
  const TrenchRun run = run_trench(session, device, feed, seconds);
  feed.close();
  reader.join();
  print_trench(device, run, delays(run, reader.arrivals()));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    wanted = argc > 1 ? argv[1] : "";
    // The trench: arrival and the first buckets.
    const double seconds = argc > 2 ? std::atof(argv[2]) : 45;
    if (argc > 3 || !(seconds > 0)) {
      std::fprintf(
          stderr,
          "usage: map_bench [NAME [SECONDS]]   rows whose name contains NAME; trench for so "
          "long (45)\n");
      return 2;
    }
    measure_queries();
    measure_updates("100m", 1000);
    measure_updates("1km", 10000);
    measure_trench(seconds);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "map_bench: %s\n", error.what());
    return 1;
  }
}
