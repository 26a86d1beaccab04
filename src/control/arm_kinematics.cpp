// SPDX-License-Identifier: Apache-2.0
#include "control/arm_kinematics.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace navvy::control {
namespace {

/// Returns the joint that the model names for a role. The loader cannot require it, because not
/// every program digs.
int require_joint(const scene::Machine& machine, const std::string& name, const char* role) {
  const int index = name.empty() ? -1 : machine.joint_index(name);
  if (index < 0)
    throw InputError(
        Fault{Fault::Severity::kError, machine.file, 0, machine.name + "/navvy:arm", name,
              std::string("the machine has no ") + role + " joint, which a digging program needs",
              "name it in the model, or leave dig, swing and dump out of the program"});
  return index;
}

}  // namespace

ArmKinematics::ArmKinematics(const scene::Machine& machine) {
  swing_ = require_joint(machine, machine.arm.swing, "swing");
  joints_ = {require_joint(machine, machine.arm.boom, "boom"),
             require_joint(machine, machine.arm.stick, "stick"),
             require_joint(machine, machine.arm.bucket, "bucket")};
  if (machine.buckets.empty())
    throw InputError(Fault{Fault::Severity::kError, machine.file, 0, machine.name + "/navvy:bucket",
                           "", "the machine has no bucket", "describe one in the model"});
  // Of several buckets on one machine, the first digs.
  bucket_data_ = machine.buckets.front();
  const auto joint = [&](int i) -> const scene::Joint& {
    return machine.joints[static_cast<std::size_t>(i)];
  };
  const auto link = [&](int i) -> const scene::Link& {
    return machine.links[static_cast<std::size_t>(i)];
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const scene::Joint& j = joint(joints_[i]);
    lower_[i] = j.has_limits ? j.lower : -kPi;
    upper_[i] = j.has_limits ? j.upper : kPi;
  }
  const scene::Joint& swing = joint(swing_);
  // A swing ring without limits turns endlessly.
  swing_limited_ = swing.has_limits;
  swing_lower_ = swing.lower;
  swing_upper_ = swing.upper;
  // All joints at zero: pins lie in the swing plane, at the joints' frames.
  const auto pin = [&](int j) {
    return Vec3((link(joint(j).child).X_ML * joint(j).X_LcJ).translation());
  };
  const Pose X_MS = link(swing.child).X_ML * swing.X_LcJ;
  X_BS_ = link(0).X_ML.inverse() * X_MS;
  const Vec3 p0 = X_MS.inverse() * pin(joints_[0]), p1 = X_MS.inverse() * pin(joints_[1]),
             p2 = X_MS.inverse() * pin(joints_[2]);
  // The arm is a chain of three bars in the swing plane: compute lengths between pins, and angles
  // of the bucket's tip and edge.
  const int bucket_link = machine.link_index(bucket_data_.link);
  const Vec3 tip = X_MS.inverse() * (link(bucket_link).X_ML * bucket_data_.p_tip);
  weigh(machine, X_MS, {p0, p1, p2});
  pin_reach_ = p0.x();
  pin_height_ = p0.z();
  boom_ = (p1 - p0).norm();
  stick_ = (p2 - p1).norm();
  bucket_ = (tip - p2).norm();
  tip_angle_ = std::atan2(tip.z() - p2.z(), tip.x() - p2.x());
  const Vec3 cut =
      X_MS.linear().transpose() * (link(bucket_link).X_ML.linear() * bucket_data_.cut_direction);
  cut_angle_ = std::atan2(cut.z(), cut.x()) - tip_angle_;
  take_outline(machine, X_MS, tip);
}

void ArmKinematics::take_outline(const scene::Machine& machine, const Pose& X_MS, const Vec3& tip) {
  for (const scene::Shell& shell : machine.shells) {
    if (shell.name != bucket_data_.shell) continue;
    const auto link = static_cast<std::size_t>(machine.link_index(shell.link));
    const Pose X_SL = X_MS.inverse() * machine.links[link].X_ML;
    const Eigen::Rotation2Dd level(-tip_angle_);
    // Pyramids from the tip, which is in the plane of the mouth, on all triangles.
    for (const auto& triangle : shell.triangles) {
      const auto corner = [&](std::size_t i) -> Vec3 {
        return shell.vertices[static_cast<std::size_t>(triangle[i])] - bucket_data_.p_tip;
      };
      struck_ -= corner(0).dot(corner(1).cross(corner(2))) / 6;
    }
    struck_ = std::abs(struck_);
    for (const Vec3& v : shell.vertices) {
      const Vec3 d = X_SL * v - tip;
      profile_.push_back(level * Vec2(d.x(), d.z()));
    }
    for (const auto& triangle : shell.triangles)
      for (std::size_t i = 0; i < 3; ++i)
        profile_edges_.push_back({triangle[i], triangle[(i + 1) % 3]});
    break;
  }
}

void ArmKinematics::weigh(const scene::Machine& machine, const Pose& X_MS,
                          const std::array<Vec3, 3>& pins) {
  for (std::size_t k = 0; k < machine.links.size(); ++k) {
    // The part that the link belongs to: that of the first of the arm's joints towards the base.
    int part = -1;
    for (int at = static_cast<int>(k); at > 0 && part < 0;) {
      int parent = 0;
      for (std::size_t j = 0; j < machine.joints.size(); ++j) {
        const scene::Joint& joint = machine.joints[j];
        if (joint.child != at) continue;
        parent = joint.parent;
        if (static_cast<int>(j) == swing_) part = 0;
        for (std::size_t i = 0; i < 3; ++i)
          if (static_cast<int>(j) == joints_[i]) part = static_cast<int>(i) + 1;
        break;
      }
      at = parent;
    }
    if (part < 0) continue;
    const scene::Link& link = machine.links[k];
    const Pose X_SL = X_MS.inverse() * link.X_ML;
    const Vec3 pin = part == 0 ? Vec3(Vec3::Zero()) : pins[static_cast<std::size_t>(part) - 1];
    const Vec3 p = X_SL * link.p_LCom - pin;
    // Second moments of the link's own mass, from its inertia: half its trace less the inertia.
    const Mat3 own = X_SL.linear() * link.inertia * X_SL.linear().transpose();
    const Mat3 second = 0.5 * own.trace() * Mat3::Identity() - own + link.mass * p * p.transpose();
    Part& out = parts_[static_cast<std::size_t>(part)];
    out.mass += link.mass;
    out.along += link.mass * p.x();
    out.across += link.mass * p.z();
    out.xx += second(0, 0);
    out.xz += second(0, 2);
    out.zz += second(2, 2);
    out.yy += second(1, 1);
  }
}

double ArmKinematics::swing_inertia(const ArmAngles& q, double load) const {
  // The upper structure does not turn in the swing plane; its pin is on the axis.
  double sum = parts_[0].xx + parts_[0].yy;
  const double lengths[3] = {boom_, stick_, bucket_};
  double reach = pin_reach_, angle = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    angle += q[i];
    const Part& part = parts_[i + 1];
    // Frames of the parts are parallel to S at joint position zero, so joint angles turn them.
    const double c = std::cos(angle), s = std::sin(angle);
    const double first = c * part.along - s * part.across;
    sum += part.mass * reach * reach + 2 * reach * first + c * c * part.xx - 2 * c * s * part.xz +
           s * s * part.zz + part.yy;
    const double line = i == 2 ? angle + tip_angle_ : angle;
    if (i == 2) sum += load * std::pow(reach + 0.5 * bucket_ * std::cos(line), 2);
    reach += lengths[i] * std::cos(line);
  }
  return sum;
}

// Only vertices can be lowest or farthest out; edges matter where they are cut off at a height.
double ArmKinematics::below_tip(double angle) const {
  const double c = std::cos(angle), s = std::sin(angle);
  double lowest = 0;
  for (const Vec2& v : profile_) lowest = std::min(lowest, s * v.x() + c * v.y());
  return -lowest;
}

BucketPose ArmKinematics::forward(const ArmAngles& q) const {
  // Angles of boom, stick and the line from pin to tip over S's plane; joint angles add up along
  // the chain.
  const double a = q[0], b = a + q[1], c = b + q[2] + tip_angle_;
  return {pin_reach_ + boom_ * std::cos(a) + stick_ * std::cos(b) + bucket_ * std::cos(c),
          pin_height_ + boom_ * std::sin(a) + stick_ * std::sin(b) + bucket_ * std::sin(c), c};
}

Vec2 ArmKinematics::on_stick(const ArmAngles& q, double along) const {
  const double a = q[0], b = a + q[1], left = stick_ - along;
  return {pin_reach_ + boom_ * std::cos(a) + left * std::cos(b),
          pin_height_ + boom_ * std::sin(a) + left * std::sin(b)};
}

double ArmKinematics::beyond_tip(double angle, double height) const {
  const Eigen::Rotation2Dd turn(angle);
  double farthest = 0;
  for (const auto& edge : profile_edges_) {
    Vec2 a = turn * profile_[static_cast<std::size_t>(edge[0])],
         b = turn * profile_[static_cast<std::size_t>(edge[1])];
    if (a.y() > b.y()) std::swap(a, b);
    // Only the part below the ground counts, so an edge is clipped at the given height.
    if (a.y() > height) continue;
    farthest = std::max(farthest, a.x());
    if (b.y() > height) b = a + (height - a.y()) / (b.y() - a.y()) * (b - a);
    farthest = std::max(farthest, b.x());
  }
  return farthest;
}

bool ArmKinematics::is_in_bucket(double angle, const Vec2& from_tip, double margin) const {
  if (profile_.empty()) return false;
  const Vec2 p = Eigen::Rotation2Dd(-angle) * from_tip;
  // Inside the convex hull is not beyond the outermost vertex in any direction; 10 deg apart, the
  // directions let a point be beside an edge by a 23rd of its length.
  constexpr int kDirections = 36;
  for (int i = 0; i < kDirections; ++i) {
    const double turn = 2 * kPi * i / kDirections;
    const Vec2 out(std::cos(turn), std::sin(turn));
    double most = out.dot(profile_.front());
    for (const Vec2& v : profile_) most = std::max(most, out.dot(v));
    if (out.dot(p) > most + margin) return false;
  }
  return true;
}

bool ArmKinematics::inverse(const BucketPose& pose, ArmAngles& q) const {
  // Locate the bucket pin in the plane of the boom's foot; then solve two bars of known length,
  // elbow up, by the law of cosines.
  const double x = pose.reach - bucket_ * std::cos(pose.angle) - pin_reach_;
  const double z = pose.height - bucket_ * std::sin(pose.angle) - pin_height_;
  const double c = (x * x + z * z - boom_ * boom_ - stick_ * stick_) / (2 * boom_ * stick_);
  // A fully stretched or folded arm counts as out of reach: joint speeds would be unbounded there.
  if (!(c > -1 && c < 1)) return false;
  const double elbow = std::acos(c);
  q[1] = -elbow;
  q[0] = std::atan2(z, x) + std::atan2(stick_ * std::sin(elbow), boom_ + stick_ * c);
  q[2] = pose.angle - tip_angle_ - q[0] - q[1];
  // The given bucket angle may differ by a full turn.
  while (q[2] > upper_[2]) q[2] -= 2 * kPi;
  while (q[2] < lower_[2]) q[2] += 2 * kPi;
  // Rounding must not reject a pose exactly at a limit, such as the present one.
  constexpr double kSlack = 1e-9;
  for (std::size_t i = 0; i < 3; ++i)
    if (q[i] < lower_[i] - kSlack || q[i] > upper_[i] + kSlack) return false;
  return true;
}

bool ArmKinematics::inverse_nearest(BucketPose& pose, ArmAngles& q) const {
  const double wish = pose.angle, step = radians(2);
  if (inverse(pose, q)) return true;
  for (int i = 1; i <= 60; ++i)
    for (const double sign : {1.0, -1.0}) {
      pose.angle = wish + sign * i * step;
      if (!inverse(pose, q)) continue;
      // The limit is within the last step; without bisection the joints would move in steps of 2
      // deg.
      double good = pose.angle, bad = pose.angle - sign * step;
      while (std::abs(good - bad) > 1e-6) {
        pose.angle = 0.5 * (good + bad);
        (inverse(pose, q) ? good : bad) = pose.angle;
      }
      pose.angle = good;
      return inverse(pose, q);
    }
  pose.angle = wish;
  return false;
}

}  // namespace navvy::control
