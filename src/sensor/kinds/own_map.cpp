// SPDX-License-Identifier: Apache-2.0
// The map that a machine makes from its own scans, and what its buckets have done to it since.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sensor/beam_errors.h"
#include "sensor/instrument.h"
#include "sim/world_terrain.h"

namespace navvy::sensor {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// A laser scanner of the machine.
struct Scanner {
  const scene::Lidar* lidar;
  std::string array;       ///< name of its array
  int index = -1;          ///< index of its array; -1 before the first look
  std::uint64_t seen = 0;  ///< last reading that is in the map

  /// Visits the last reading.
  void visit(Archive& a) { a("seen", seen); }
};

/// The space of a bucket or bed and of the heap on it, in the frame of its link.
struct Carrier {
  sim::LinkHandle link;
  Vec3 low, high;                ///< box around the shell [m]
  Vec3 opening;                  ///< unit vector out of the mouth
  double heap;                   ///< height of a heap with slopes of 45 deg on the mouth [m]
  Pose X_LW = Pose::Identity();  ///< pose of W in the link's frame
  double heaped = 0;             ///< height of the heap as the mouth is turned now [m]

  /// Creates the space of a shell.
  Carrier(const sim::LinkHandle& of, const scene::Shell& shell, const Vec3& out)
      : link(of),
        low(shell.vertices.front()),
        high(shell.vertices.front()),
        opening(out.normalized()) {
    for (const Vec3& v : shell.vertices) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
    // Across the mouth: the two axes that are farthest from the direction of the opening.
    int along = 0;
    opening.cwiseAbs().maxCoeff(&along);
    const Vec3 size = high - low;
    heap = 0.5 * std::min(size[(along + 1) % 3], size[(along + 2) % 3]);
  }
  /// Follows the link.
  void update() {
    const Pose X_WL = link.pose();
    X_LW = X_WL.inverse();
    // Nothing rests on a mouth that points sideways or down.
    heaped = heap * std::max(0.0, (X_WL.linear() * opening).z());
  }
  /// Returns true if a point is in the shell or in the heap on it, within `margin` [m].
  bool holds(const Vec3& p_W, double margin) const {
    const Vec3 p = X_LW * p_W, up = heaped * opening;
    return (p.array() >= low.array() + up.array().min(0) - margin).all() &&
           (p.array() <= high.array() + up.array().max(0) + margin).all();
  }
};

class MapInstrument final : public Instrument {
 public:
  MapInstrument(const scene::OwnMap& kind, const Mounting& at)
      : kind_(kind), at_(at), machine_(at.machine_handle()) {
    const heightfield::Terrain& site = at.world.ground();
    if (kind_.cell == 0) kind_.cell = site.cell();
    if (!kind_.has_area) {
      kind_.min = site.origin();
      kind_.max = site.origin() + site.cell() * Vec2(site.nx(), site.ny());
    }
    const Vec2 cells =
        ((kind_.max - kind_.min) / kind_.cell - Vec2::Constant(1e-6)).array().ceil().matrix();
    nx_ = std::max(1, static_cast<int>(cells.x()));
    ny_ = std::max(1, static_cast<int>(cells.y()));
    elevation_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), kUnknown);
    predicted_ = elevation_;
    sum_.assign(elevation_.size(), 0);
    points_.assign(elevation_.size(), 0);
    for (const scene::Link& link : machine_.description().links)
      for (const scene::Sensor& sensor : link.sensors)
        if (const auto* lidar = std::get_if<scene::Lidar>(&sensor.kind))
          scanners_.push_back({lidar, machine_.name() + "/" + sensor.name + "/ranges"});
    add_carriers();
  }

  std::vector<MeasuredQuantity> quantities() const override {
    return {{"elevation",
             "m",
             "heights that the machine's scanners have seen; NaN: unknown",
             sim::ElementType::kFloat32,
             {ny_, nx_}},
            {"predicted",
             "m",
             "elevation, cut where a bucket has passed since it was seen",
             sim::ElementType::kFloat32,
             {ny_, nx_}},
            {"score",
             "1, m, m, m",
             "share of known cells; rms, mean and largest magnitude of elevation - truth",
             sim::ElementType::kFloat64,
             {4}}};
  }
  void follow() override {
    for (Scanner& scanner : scanners_) take(scanner);
    for (const scene::Bucket& bucket : machine_.description().buckets)
      for (const scene::Shell& shell : machine_.description().shells)
        if (shell.name == bucket.shell) cut(shell);
  }
  void measure(int, const Pose&, Values& out) override {
    for (std::size_t i = 0; i < elevation_.size(); ++i) {
      out[0][i] = elevation_[i];
      out[1][i] = predicted_[i];
    }
    score(out[2]);
  }
  void finish(Values&, double, Random&) override {}
  void visit(Archive& a) override {
    a("elevation", elevation_);
    a("predicted", predicted_);
    a.require(elevation_.size() == sum_.size() && predicted_.size() == sum_.size(), "elevation",
              "a map of another size; load it with the same sensors");
    const std::uint64_t count = a.size("scanners", scanners_.size());
    a.require(count == scanners_.size(), "scanners", "another number of laser scanners");
    for (std::uint64_t i = 0; i < count && i < scanners_.size(); ++i)
      a.item(i, [&] { a("scanner", scanners_[i]); });
  }

 private:
  void add_carriers() {
    const scene::Machine& machine = machine_.description();
    for (std::size_t i = 0; i < machine.shells.size(); ++i) {
      const scene::Shell& shell = machine.shells[i];
      if (shell.vertices.empty()) continue;
      for (const scene::Bucket& bucket : machine.buckets)
        if (bucket.shell == shell.name)
          carriers_.emplace_back(machine_.link(shell.link), shell, bucket.opening);
      if (machine.is_bed(static_cast<int>(i)))
        carriers_.emplace_back(machine_.link(shell.link), shell, Vec3::UnitZ());
    }
  }
  /// Returns the index of the cell at a place in W; -1 outside the map.
  std::ptrdiff_t cell_at(double x, double y) const {
    const int ix = static_cast<int>(std::floor((x - kind_.min.x()) / kind_.cell)),
              iy = static_cast<int>(std::floor((y - kind_.min.y()) / kind_.cell));
    return ix < 0 || iy < 0 || ix >= nx_ || iy >= ny_ ? -1 : ix + std::ptrdiff_t{nx_} * iy;
  }

  /// Adds a new scan to the map. The points of one cell count by their mean.
  void take(Scanner& scanner) {
    if (scanner.index < 0) scanner.index = at_.world.arrays().find(scanner.array);
    if (scanner.index < 0) return;
    const sim::ArrayView view = at_.world.arrays().view(scanner.index);
    if (view.sequence() == scanner.seen) return;
    scanner.seen = view.sequence();
    at_.scene->update();
    for (Carrier& carrier : carriers_) carrier.update();
    touched_.clear();
    const std::span<const float> ranges = view.values<float>();
    const scene::Lidar& lidar = *scanner.lidar;
    std::size_t i = 0;
    for (int ring = 0; ring < lidar.vertical.samples; ++ring)
      for (int beam = 0; beam < lidar.horizontal.samples; ++beam, ++i) {
        if (!std::isfinite(ranges[i])) continue;
        const double up = lidar.vertical.angle(ring), a = lidar.horizontal.angle(beam);
        const Vec3 d(std::cos(up) * std::cos(a), std::cos(up) * std::sin(a), std::sin(up));
        add(view.X_WF() * (static_cast<double>(ranges[i]) * d));
      }
    for (const std::size_t cell : touched_) fuse(cell);
  }
  void add(const Vec3& p_W) {
    const std::ptrdiff_t cell = cell_at(p_W.x(), p_W.y());
    if (cell < 0) return;
    if (kind_.self_filter &&
        (at_.scene->on_machine(at_.machine, p_W, kind_.margin) ||
         std::any_of(carriers_.begin(), carriers_.end(),
                     [&](const Carrier& c) { return c.holds(p_W, kind_.margin); })))
      return;
    const auto c = static_cast<std::size_t>(cell);
    if (points_[c]++ == 0) touched_.push_back(c);
    sum_[c] += p_W.z();
  }
  void fuse(std::size_t cell) {
    const double mean = sum_[cell] / points_[cell], old = static_cast<double>(elevation_[cell]);
    // A step of more than a cell is another surface, not noise.
    const bool same = std::abs(mean - old) <= kind_.cell;
    const double weight = same ? kind_.memory : 0;
    elevation_[cell] = static_cast<float>(
        (weight > 0 ? weight * old + points_[cell] * mean : points_[cell] * mean) /
        (weight + points_[cell]));
    predicted_[cell] = elevation_[cell];
    sum_[cell] = 0;
    points_[cell] = 0;
  }

  /// Lowers the predicted ground to the lowest steel above each cell: what is higher has been cut.
  void cut(const scene::Shell& shell) {
    const Pose X_WL = machine_.link(shell.link).pose();
    for (const auto& t : shell.triangles) {
      std::array<Vec3, 3> p;
      for (std::size_t i = 0; i < 3; ++i)
        p[i] = X_WL * shell.vertices[static_cast<std::size_t>(t[i])];
      cut(p, shell.half_thickness);
    }
  }
  void cut(const std::array<Vec3, 3>& p, double thickness) {
    const Vec3 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    // Steel on edge covers no cell.
    if (std::abs(normal.z()) < 1e-9) return;
    const auto index = [&](double v, double from) {
      return static_cast<int>(std::floor((v - from) / kind_.cell));
    };
    const int x0 = std::max(0, index(low.x(), kind_.min.x())),
              x1 = std::min(nx_ - 1, index(high.x(), kind_.min.x())),
              y0 = std::max(0, index(low.y(), kind_.min.y())),
              y1 = std::min(ny_ - 1, index(high.y(), kind_.min.y()));
    for (int iy = y0; iy <= y1; ++iy)
      for (int ix = x0; ix <= x1; ++ix) {
        const Vec2 q = kind_.min + kind_.cell * Vec2(ix + 0.5, iy + 0.5);
        if (!covers(p, q)) continue;
        const double z =
            p[0].z() - (normal.head<2>().dot(q - p[0].head<2>())) / normal.z() - thickness;
        float& ground = predicted_[static_cast<std::size_t>(ix + nx_ * iy)];
        // Comparisons with NaN are false: unknown ground stays unknown.
        if (z < static_cast<double>(ground)) ground = static_cast<float>(z);
      }
  }
  /// Returns true if a point is inside a triangle as seen from above.
  static bool covers(const std::array<Vec3, 3>& p, const Vec2& q) {
    bool left = false, right = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec2 a = p[i].head<2>(), b = p[(i + 1) % 3].head<2>();
      const double side = (b - a).x() * (q - a).y() - (b - a).y() * (q - a).x();
      left = left || side > 0;
      right = right || side < 0;
    }
    return !(left && right);
  }

  /// Compares the elevation with the true ground and the loose soil that rests on it.
  void score(std::vector<double>& out) const {
    const heightfield::TerrainView truth =
        sim::terrain_view(at_.world, heightfield::SurfaceKind::kMapped);
    double count = 0, squares = 0, sum = 0, largest = 0;
    for (int iy = 0; iy < ny_; ++iy)
      for (int ix = 0; ix < nx_; ++ix) {
        const double seen =
            static_cast<double>(elevation_[static_cast<std::size_t>(ix + nx_ * iy)]);
        if (std::isnan(seen)) continue;
        const Vec2 q = kind_.min + kind_.cell * Vec2(ix + 0.5, iy + 0.5);
        const double error = seen - truth.sample(q.x(), q.y());
        count += 1;
        squares += error * error;
        sum += error;
        largest = std::max(largest, std::abs(error));
      }
    const double known = std::max(count, 1.0);
    out = {count / static_cast<double>(elevation_.size()), std::sqrt(squares / known), sum / known,
           largest};
  }

  scene::OwnMap kind_;
  Mounting at_;
  sim::MachineHandle machine_;
  int nx_ = 1, ny_ = 1;  ///< number of cells along x and y
  std::vector<Scanner> scanners_;
  std::vector<Carrier> carriers_;  ///< buckets and beds, whose soil is not ground
  std::vector<float> elevation_;   ///< seen heights, x fastest [m]
  std::vector<float> predicted_;   ///< heights with cuts since they were seen [m]
  // Points of the scan that is being added: their sums and numbers by cell, and the cells with any.
  std::vector<double> sum_;
  std::vector<int> points_;
  std::vector<std::size_t> touched_;
};

}  // namespace

std::unique_ptr<Instrument> make(const scene::OwnMap& kind, const Mounting& at, Random&) {
  return std::make_unique<MapInstrument>(kind, at);
}

}  // namespace navvy::sensor
