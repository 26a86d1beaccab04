// SPDX-License-Identifier: Apache-2.0
#include "earthwork/cut_fan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "earthwork/station_search.h"
#include "scene/polygon.h"

namespace navvy::earthwork {
namespace {

constexpr double kSample = 0.1;     // along a cut [m]
constexpr double kTouching = 0.95;  // distance of strips at the farthest soil / bucket width
// The part of a strip that decides its floor reaches so far beyond the middle to its neighbour's
// [m]. tuned: DigArea.BacksFromStationToStation; 0 and 0.04 over-dig by 0.103 and 0.087 m rms.
constexpr double kAside = 0.04;
// Soil above the floor at the ends of a cut [m]; in a shallow job this share of its depth.
constexpr double kLeastSoil = 0.1, kLeastShare = 0.3;
constexpr double kLeastLength = 0.8;  // of a cut [m]
// A pass ends so far beyond its last soil [m], or the curl leaves a ramp there; but not above a
// side so high there [m]: the bucket would be thrown up and lose its load.
constexpr double kBeyondEdge = 0.6, kHighEdge = 0.25;
// Where it is square to such a side, it goes on at the depth of the floor so far beyond it [m]: the
// ramp of the curl lies outside. It begins so far before that end [m], on dug floor if need be, or
// the bucket has no space to curl.
constexpr double kBreakOut = 0.6, kCurlSpace = 2.1;
// It begins so far beyond a side that it meets at its far end [m]: the bucket keeps clear of the
// end of a cut, and is down only some way from it.
constexpr double kFarOut = 0.2;
// A fill has mounds where a load fell: its level is looked at over so many samples at a time.
constexpr std::size_t kMound = 10;
constexpr int kAcross = 5;  // places across a strip at which its soil is looked at
constexpr int kFine = 3;    // directions per strip
// Height of the stick's line over soil that it must not touch while the bucket goes down beyond it,
// and how far from the bucket's pin that is looked at [m].
constexpr double kUnderStick = 0.3, kAlongStick = 1.5;
// Keys: layers are so far apart, and directions count from the middle of that.
constexpr std::int64_t kLayerKeys = 1000;

/// Strips of one machine in one pit.
class Fan {
 public:
  Fan(const control::PitJob& job, const PitShape& pit, const ArmReach& reach, const Pose& X_WB,
      const control::SurfaceView& surface, const FanLimits& limits)
      : pit_(pit),
        reach_(reach),
        surface_(surface),
        width_(reach.arm().bucket().width),
        capacity_(reach.arm().bucket().capacity),
        slope_(limits.face ? face_slope(job) : std::numeric_limits<double>::infinity()),
        tolerance_(limits.tolerance > 0 ? limits.tolerance : job.tolerance),
        sector_(limits.sector),
        aside_(limits.aside),
        nearest_(limits.nearest),
        worth_above_(limits.worth_above),
        worth_last_(limits.worth_last),
        outside_(limits.outside),
        least_soil_(std::min(kLeastSoil, kLeastShare * job.area.depth)),
        fills_(job.heap.has_value()),
        square_(limits.square),
        levels_beyond_(limits.levels_beyond) {
    const Pose X_WS = X_WB * reach.arm().X_BS();
    centre_ = X_WS.translation().head<2>();
    ring_ = X_WS.translation().z();
    heading_ = control::plane_pose(X_WB).yaw;
    if (square_) {
      const Vec2 side = scene::longest_edge(job.area.polygon);
      const double along = std::atan2(side.y(), side.x());
      heading_ = along + std::round((heading_ - along) / (kPi / 2)) * kPi / 2;
    }
    layers_ = std::max(
        1, static_cast<int>(std::ceil((pit.ground() - pit.lowest()) / job.pass_depth - 1e-9)));
    turn_ = kTouching * width_ / std::max(kFaceBegins, farthest());
  }

  std::vector<control::JobCut> cuts() const {
    std::vector<control::JobCut> out;
    for (int layer = 1; layer <= layers_; ++layer) {
      std::vector<Strip> strips;
      const int most = static_cast<int>(sector_ / turn_ * kFine);
      for (int i = -most; i <= most; ++i)
        if (std::optional<Strip> one = strip(layer, i)) strips.push_back(*std::move(one));
      std::stable_sort(strips.begin(), strips.end(),
                       [](const Strip& a, const Strip& b) { return a.volume > b.volume; });
      for (Strip& one : strips) out.push_back(std::move(one.cut));
    }
    const int most = static_cast<int>(sector_ / turn_);
    for (int i = -most; i <= most && tolerance_ > 0; ++i)
      if (std::optional<control::JobCut> one = level(i)) out.push_back(*std::move(one));
    return out;
  }
  std::size_t count() const {
    std::size_t out = 0;
    const int most = static_cast<int>(sector_ / turn_);
    for (int i = -most; i <= most; ++i) {
      for (int layer = 1; layer <= layers_; ++layer) out += strip(layer, kFine * i) ? 1 : 0;
      out += tolerance_ > 0 && level(i) ? 1 : 0;
    }
    return out;
  }

 private:
  /// A cut, and the volume of soil above its floor [m3].
  struct Strip {
    control::JobCut cut;
    double volume = 0;
  };

  /// Returns the distance of the farthest column of the pit that the arm reaches [m].
  double farthest() const {
    double out = 0;
    for (const PitColumn& one : pit_.columns()) {
      const double r = (one.p - centre_).norm();
      if (r > out && r <= reach_.at(one.floor - ring_).most) out = r;
    }
    return out;
  }

  /// Returns the height of the floor of a layer at a distance in a direction [m]: the highest
  /// design over the part of the strip that no neighbour digs; nothing outside of the pit.
  std::optional<double> floor(double r, double angle, double layer_z) const {
    const Vec2 along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
    if (std::abs(r * std::sin(angle - heading_)) > aside_) return std::nullopt;
    const double aside = kAside + std::max(0.0, 0.5 * (width_ - r * turn_));
    double out = std::max(layer_z, pit_.ground() - (r - kFaceBegins) * slope_);
    for (const double t : {-aside, 0.0, aside}) {
      const double z = pit_.floor(centre_ + r * along + t * across);
      if (std::isnan(z)) return std::nullopt;
      out = std::max(out, z);
    }
    // The bucket's sides stay inside.
    const double side = 0.5 * width_ - outside_;
    for (const double t : {-side, side})
      if (side > aside && std::isnan(pit_.floor(centre_ + r * along + t * across)))
        return std::nullopt;
    return out;
  }

  /// Calls `use` with kAcross points across the bucket, at the distance `r` [m] in a direction
  /// [rad].
  template <class Use>
  void across(double r, double angle, const Use& use) const {
    const Vec2 along(std::cos(angle), std::sin(angle)), aside(-along.y(), along.x());
    for (int k = 0; k < kAcross; ++k)
      use(Vec2(centre_ + r * along + width_ * ((k + 0.5) / kAcross - 0.5) * aside));
  }

  /// Returns the mean height of the soil above `z` across the bucket [m].
  double above(double r, double angle, double z) const {
    double sum = 0;
    across(r, angle,
           [&](const Vec2& p) { sum += std::max(0.0, surface_.height(p.x(), p.y()) - z); });
    return sum / kAcross;
  }

  /// Returns true if the stick stays above the soil while the bucket goes down to `z` [m] at the
  /// distance `r` [m] in a direction [rad]. Behind the crest of a heap it would touch it.
  bool stick_is_clear(double r, double angle, double z) const {
    control::BucketPose pose{r, z - ring_, control::with_cut(reach_.arm(), control::kPlunge)};
    control::ArmAngles q;
    if (!reach_.arm().inverse_nearest(pose, q)) return true;
    for (double along = 0; along <= kAlongStick; along += kSample) {
      const Vec2 at = reach_.arm().on_stick(q, along);
      const Vec2 p = centre_ + at.x() * Vec2(std::cos(angle), std::sin(angle));
      if (ring_ + at.y() - kUnderStick < surface_.height(p.x(), p.y())) return false;
    }
    return true;
  }

  /// Returns the strip of a layer in direction `i`, of kFine per strip; nothing if it is not worth
  /// a scoop.
  std::optional<Strip> strip(int layer, int i) const {
    const double angle = heading_ + i * turn_ / kFine;
    const double layer_z = pit_.ground() + (pit_.lowest() - pit_.ground()) * layer / layers_;
    const Vec2 along(std::cos(angle), std::sin(angle));
    Strip found;
    control::JobCut& out = found.cut;
    std::vector<double> floors;
    int first = -1, last = -1, inside = -1;
    std::vector<double> soils;
    const double worth = layer == layers_ ? worth_last_ : worth_above_;
    const int samples = static_cast<int>((reach_.arm().longest() + 2 - kFaceBegins) / kSample);
    for (int k = 0; k <= samples; ++k) {
      const double r = kFaceBegins + k * kSample;
      const Vec2 p = centre_ + r * along;
      const double top = surface_.height(p.x(), p.y());
      const std::optional<double> z = floor(r, angle, layer_z);
      const bool reached = z && r >= nearest_ && r <= reach_.at(*z - ring_).most;
      const double soil = reached ? above(r, angle, *z) : 0;
      const bool digs = soil > 0;
      if (reached) inside = k;
      // Where nothing is to be dug, the edge stays on the ground.
      floors.push_back(digs ? *z : z ? std::max(*z, top) : top);
      soils.push_back(digs && soil >= least_soil_ ? soil : 0);
      if (soils.back() == 0) continue;
      if (first < 0) first = k;
      last = k;
    }
    const auto far = [&] { return static_cast<std::size_t>(last); };
    while (last > first && (soils[far()] == 0 ||
                            !stick_is_clear(kFaceBegins + last * kSample, angle, floors[far()])))
      --last;
    for (int k = std::max(first, 0); k <= last; ++k)
      found.volume += soils[static_cast<std::size_t>(k)] * width_ * kSample;
    if (first < 0 || (last - first) * kSample < kLeastLength || found.volume < worth * capacity_)
      return std::nullopt;
    const bool high = soils[static_cast<std::size_t>(first)] > kHighEdge;
    int begin = high ? first : first - beyond(first);
    if (high && square_) {
      begin = std::max(0, first - static_cast<int>(kBreakOut / kSample));
      std::fill(floors.begin() + begin, floors.begin() + first,
                floors[static_cast<std::size_t>(first)]);
      last = std::max(last, std::min(inside, begin + static_cast<int>(kCurlSpace / kSample)));
      if (last == inside) {
        const double z = floors[far()];
        const int more = samples_beyond(last, z, kFarOut);
        std::fill_n(floors.begin() + last + 1, more, z);
        last += more;
      }
    }
    out.near = centre_ + (kFaceBegins + begin * kSample) * along;
    out.far = centre_ + (kFaceBegins + last * kSample) * along;
    out.floor.assign(floors.begin() + begin, floors.begin() + last + 1);
    out.rim = pit_.rim();
    out.key = layer * kLayerKeys + i + kLayerKeys / 2;
    out.worth = worth;
    return found;
  }

  /// Returns by how many samples a strip may go on beyond its last one inside the pit, `last`, at
  /// the height `z` [m]: `length` [m], as far as the arm reaches.
  int samples_beyond(int last, double z, double length) const {
    const auto most = static_cast<int>(std::lround(length / kSample));
    int out = 0;
    while (out < most && kFaceBegins + (last + out + 1) * kSample <= reach_.at(z - ring_).most)
      ++out;
    return out;
  }

  /// Returns by how many samples a cut whose soil begins at the sample `first` ends nearer.
  static int beyond(int first) { return std::min(first, static_cast<int>(kBeyondEdge / kSample)); }

  /// Returns the sum of the squares of the heights [m2] by which soil stands above the floor `z` of
  /// a strip, over kAcross places across it.
  double deviation(double r, double angle, double z) const {
    double out = 0;
    across(r, angle, [&](const Vec2& p) {
      if (!std::isnan(pit_.floor(p)))
        out += std::pow(std::max(0.0, surface_.height(p.x(), p.y()) - z), 2);
    });
    return out;
  }

  /// Returns the deviation (rms) of a strip whose samples have these sums of squares [m]: over all
  /// of it, or of a fill where it is largest.
  double worst_mean(const std::vector<double>& squares) const {
    const std::size_t window = fills_ ? std::min(kMound, squares.size()) : squares.size();
    double worst = 0, sum = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      sum += squares[i];
      if (i >= window) sum -= squares[i - window];
      if (i + 1 >= window) worst = std::max(worst, sum);
    }
    return std::sqrt(worst / static_cast<double>(kAcross * window));
  }

  /// Returns the strip in direction `i` for a pass that levels it; nothing if it is level.
  std::optional<control::JobCut> level(int i) const {
    const double angle = heading_ + i * turn_;
    const Vec2 along(std::cos(angle), std::sin(angle));
    control::JobCut out;
    std::vector<double> floors, before, squares;
    int first = -1, last = -1;
    const int samples = static_cast<int>((reach_.arm().longest() + 2 - kFaceBegins) / kSample);
    for (int k = 0; k <= samples; ++k) {
      const double r = kFaceBegins + k * kSample;
      const std::optional<double> z = floor(r, angle, pit_.lowest());
      const bool inside = z && r >= nearest_ && r <= reach_.at(*z - ring_).most;
      // One stretch of the strip, the nearest.
      if (!inside && first >= 0) break;
      const Vec2 p = centre_ + r * along;
      if (!inside) before.push_back(surface_.height(p.x(), p.y()));
      if (!inside) continue;
      if (first < 0) first = k;
      last = k;
      floors.push_back(*z);
      squares.push_back(deviation(r, angle, *z));
    }
    const int length = last - first;
    if (first < 0 || length * kSample < kLeastLength || worst_mean(squares) <= tolerance_)
      return std::nullopt;
    const int farther = levels_beyond_ ? samples_beyond(last, floors.back(), kFarOut) : 0;
    floors.insert(floors.end(), static_cast<std::size_t>(farther), floors.back());
    last += farther;
    const bool out_at_depth = square_ || levels_beyond_;
    const int more =
        out_at_depth ? std::min(first, static_cast<int>(kBreakOut / kSample)) : beyond(first);
    if (out_at_depth)
      floors.insert(floors.begin(), static_cast<std::size_t>(more), floors.front());
    else
      floors.insert(floors.begin(), before.end() - more, before.end());
    out.near = centre_ + (kFaceBegins + (first - more) * kSample) * along;
    out.far = centre_ + (kFaceBegins + last * kSample) * along;
    out.floor = std::move(floors);
    out.rim = pit_.rim();
    out.key = (layers_ + 1) * kLayerKeys + i + kLayerKeys / 2;
    out.levels = true;
    return out;
  }

  const PitShape& pit_;
  const ArmReach& reach_;
  const control::SurfaceView& surface_;
  const double width_, capacity_, slope_, tolerance_, sector_, aside_, nearest_, worth_above_,
      worth_last_, outside_, least_soil_;
  const bool fills_, square_, levels_beyond_;
  Vec2 centre_ = Vec2::Zero();
  double ring_ = 0, heading_ = 0, turn_ = 0.1;
  int layers_ = 1;
};

}  // namespace

std::vector<control::JobCut> cut_fan(const control::PitJob& job, const PitShape& pit,
                                     const ArmReach& reach, const Pose& X_WB,
                                     const control::SurfaceView& surface, const FanLimits& limits) {
  return Fan(job, pit, reach, X_WB, surface, limits).cuts();
}

std::size_t count_strips(const control::PitJob& job, const PitShape& pit, const ArmReach& reach,
                         const Pose& X_WB, const control::SurfaceView& surface,
                         const FanLimits& limits) {
  return Fan(job, pit, reach, X_WB, surface, limits).count();
}

}  // namespace navvy::earthwork
