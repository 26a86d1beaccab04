// SPDX-License-Identifier: Apache-2.0
// Kinematic engine: machines follow their commands at limited rates, and no force moves them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/limits.h"
#include "scene/close_loops.h"
#include "vehicle/drive/drive_line.h"
#include "vehicle/kinematics.h"
#include "vehicle/physics_engine.h"

namespace navvy::vehicle {
namespace {

constexpr std::uint32_t kVersion = 4;

struct Body {
  scene::Machine machine;
  Pose X_WB = Pose::Identity();  // of links[0]
  Vec3 v_W = Vec3::Zero(), w_W = Vec3::Zero();
  std::vector<JointInput> input;
  std::vector<double> q, qd;
  std::vector<std::uint8_t> braked;  // by joint
  // Joints that a joint command has taken over from the drive.
  std::vector<std::uint8_t> taken;
  DriveInput drive;
  // Base inputs move it, not its drive.
  bool placed = false;
  BaseInput goal;
  // Time left to the goal [s].
  double left = 0;
  // Used for its kinematics; this engine has no torques.
  std::unique_ptr<DriveLine> line;
  std::vector<DriveWheel> wheels;  // by wheel
  std::vector<LinkState> links;
};

std::size_t index(int i) { return static_cast<std::size_t>(i); }

class KinematicEngine final : public PhysicsEngine, private PlacementCapability {
 public:
  int add_machine(const scene::Machine& machine, const Pose& X_WM) override {
    if (machine.links.empty()) {
      Fault fault;
      fault.element = "machine[" + machine.name + "]";
      fault.rule = "needs at least one link";
      throw InputError(fault);
    }
    Body body;
    body.machine = machine;
    // All further poses are those of the base link; the model frame only gives the start.
    body.X_WB = X_WM * machine.links[0].X_ML;
    body.line = make_drive_line(machine);
    body.wheels = drive_wheels(machine);
    body.q.resize(machine.joints.size());
    body.qd.assign(machine.joints.size(), 0);
    body.taken.assign(machine.joints.size(), 0);
    body.braked.assign(machine.joints.size(), 0);
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      body.q[j] = machine.joints[j].initial;
      // Until a command comes, every joint holds its position at the start; passive ones move with
      // their loop alone.
      body.input.push_back(
          {machine.joints[j].passive ? JointMode::kFree : JointMode::kPosition, body.q[j]});
    }
    bodies_.push_back(std::move(body));
    update_links(bodies_.back());
    return machine_count() - 1;
  }
  int machine_count() const override { return static_cast<int>(bodies_.size()); }

  void set_joint(int machine, int joint, const JointInput& input) override {
    Body& body = at(machine);
    body.input.at(index(joint)) = input;
    // Taken from the drive until its next command.
    body.taken[index(joint)] = 1;
  }
  void set_drive(int machine, const DriveInput& input) override {
    Body& body = at(machine);
    body.drive = input;
    body.placed = false;
    for (const scene::Wheel& wheel : body.machine.wheels)
      for (const int joint :
           {body.machine.joint_index(wheel.joint), body.machine.joint_index(wheel.steer_joint)})
        // A machine without a drive keeps the commands of its wheels, as nothing else would move
        // them.
        if (body.machine.has_drive && joint >= 0 && body.taken[index(joint)] != 0) {
          body.taken[index(joint)] = 0;
          body.input[index(joint)] = {JointMode::kFree, 0};
        }
  }
  void set_brake(int machine, int joint, bool on) override {
    Body& body = at(machine);
    if (body.machine.joints.at(index(joint)).brake > 0) body.braked[index(joint)] = on ? 1 : 0;
  }
  DriveInput drive(int machine) const override { return at(machine).drive; }
  void set_base(int machine, const BaseInput& input) override {
    Body& body = at(machine);
    body.placed = true;
    body.goal = input;
    body.left = input.duration;
  }
  BaseInput base(int machine) const override {
    const Body& body = at(machine);
    if (body.placed) return body.goal;
    // Without a goal the pose of this moment is the command, so that changing one value of it
    // leaves the others.
    BaseInput out;
    out.p_W = body.links[0].X_WL.translation();
    out.angles = fixed_angles(body.links[0].X_WL.linear());
    return out;
  }
  PlacementCapability* placement() override { return this; }
  // Impulses and forces have no effect.
  void apply_impulse(int, int, const Vec3&, const Vec3&, const Vec3&) override {}
  void apply_impulse_of_step(int, int, const Vec3&, const Vec3&, const Vec3&, double) override {}
  void add_force(int, int, const Vec3&, const Vec3&) override {}

  void step(double dt, const GroundQuery& ground) override {
    if (!(dt > 0))
      throw SimulationError("vehicle: the step must be positive, it is " + std::to_string(dt));
    for (Body& body : bodies_) {
      // Joints first: a drive may then command its wheels' joints for the next step.
      move_joints(body, dt);
      move_mechanisms(body, dt);
      if (body.placed)
        move_to_goal(body, dt);
      else if (body.machine.has_drive)
        move_base(body, ground, dt);
      update_links(body);
    }
  }

  JointState joint(int machine, int joint) const override {
    const Body& body = at(machine);
    const scene::Joint& about = body.machine.joints.at(index(joint));
    JointState state;
    state.position = body.q[index(joint)];
    state.velocity = body.qd[index(joint)];
    state.effort_limit = about.effort;
    state.velocity_limit = about.velocity;
    state.braked = body.braked[index(joint)] != 0;
    for (const scene::Cylinder& cylinder : body.machine.cylinders)
      if (cylinder.joint == about.name)
        state.cylinder_length = cylinder_geometry(body.machine, cylinder, state.position).length;
    return state;
  }
  LinkState link(int machine, int link) const override { return at(machine).links.at(index(link)); }
  WheelState wheel(int machine, int wheel) const override {
    const Body& body = at(machine);
    const scene::Wheel& about = body.machine.wheels.at(index(wheel));
    const int joint = body.machine.joint_index(about.joint);
    WheelState state;
    if (joint < 0) return state;
    const scene::Joint& spin = body.machine.joints[index(joint)];
    const LinkState& carrier = body.links[index(spin.parent)];
    // Computed from the carrier with the spin joint at 0: the wheel's frame does not spin with it.
    state.X_WWheel = carrier.X_WL * joint_pose(body.machine, spin, 0) * spin.X_LcJ;
    state.v_W = carrier.v_WL +
                carrier.w_WL.cross(state.X_WWheel.translation() - carrier.X_WL.translation());
    state.spin = body.qd[index(joint)];
    const int steer = body.machine.joint_index(about.steer_joint);
    if (steer >= 0) state.steer = body.q[index(steer)];
    return state;
  }
  /// Returns zero: no force moves the link.
  Mat6 inverse_mass(int, int) const override { return Mat6::Zero(); }

  void visit(Archive& a) override {
    a.section("kinematic", kVersion, [&] {
      a.constant("machines", bodies_.size(),
                 "the snapshot has another number of kinematic machines than the scene");
      for (std::size_t b = 0; b < bodies_.size(); ++b)
        a.item(b, [&] { visit_body(bodies_[b], a); });
    });
  }

 private:
  Body& at(int machine) { return bodies_.at(index(machine)); }
  const Body& at(int machine) const { return bodies_.at(index(machine)); }

  static void visit_body(Body& body, Archive& a) {
    a("X_WB", body.X_WB);
    a("v_W", body.v_W);
    a("w_W", body.w_W);
    a.fixed("q", body.q);
    a.fixed("qd", body.qd);
    a.fixed("input", body.input);
    a.fixed("taken", body.taken);
    for (std::size_t j = 0; j < body.braked.size(); ++j) visit_brake(body, j, a);
    a("drive", body.drive);
    if (const scene::CombustionEngine* engine = scene::drive_engine(body.machine.drive))
      a.ranged("gear", body.drive.gear, 0, static_cast<int>(engine->gears.size()));
    a("placed", body.placed);
    a("goal", body.goal);
    a.ranged("left", body.left, 0.0, std::numeric_limits<double>::max());
    a.require(body.goal.p_W.allFinite() && body.goal.angles.allFinite() &&
                  body.goal.p_W.norm() < limits::kFarthest,
              "goal", "the target of a base must be finite and near the site");
    a.require(body.X_WB.translation().norm() < limits::kFarthest, "X_WB",
              "the pose of a machine must be finite and near the site");
    // Poses of all links follow from base and joints.
    if (a.loading()) update_links(body);
  }

  static void visit_brake(Body& body, std::size_t j, Archive& a) {
    if (!(body.machine.joints[j].brake > 0)) return;
    a.unhashed("hashed while it is set", [&] { a.ranged("braked", body.braked[j], 0, 1); });
    if (body.braked[j] == 0) return;
    // Hash which brake is set. Without a set brake the hash is that of a machine without brakes.
    int which = static_cast<int>(j) + 1;
    a("on", which);
    a.require(which == static_cast<int>(j) + 1, "on", "the snapshot has another joint's brake set");
  }
  /// Returns the speed [rad/s|m/s] of a joint whose valve is open by `opening`, -1 to 1: that of
  /// its cylinder at the present position, if it has one, at most the joint's own.
  static double opened_speed(const Body& body, std::size_t j, double opening) {
    const scene::Joint& joint = body.machine.joints[j];
    double most = joint.velocity;
    for (const scene::Cylinder& cylinder : body.machine.cylinders) {
      if (cylinder.joint != joint.name) continue;
      const CylinderLimits limits = cylinder_limits(body.machine, cylinder, body.q[j]);
      // With several cylinders, the slowest one decides.
      most = std::min(most, opening > 0 ? limits.speed_positive : limits.speed_negative);
    }
    return std::clamp(opening, -1.0, 1.0) * most;
  }

  static void move_joints(Body& body, double dt) {
    for (std::size_t j = 0; j < body.q.size(); ++j) {
      const scene::Joint& joint = body.machine.joints[j];
      // Free joints and joints under effort stay: no force moves them.
      double wanted = body.q[j];
      if (body.input[j].mode == JointMode::kPosition) wanted = body.input[j].target;
      if (body.input[j].mode == JointMode::kVelocity) wanted += dt * body.input[j].target;
      if (body.input[j].mode == JointMode::kOpening)
        wanted += dt * opened_speed(body, j, body.input[j].target);
      // The brake comes after all modes and before the limits, so that it holds against each of
      // them.
      if (body.braked[j] != 0) wanted = body.q[j];
      if (joint.has_limits) wanted = std::clamp(wanted, joint.lower, joint.upper);
      // The joint reaches its largest rate at once: it has no inertia and no valve.
      const double most = joint.velocity * dt;
      const double next = std::clamp(wanted, body.q[j] - most, body.q[j] + most);
      body.qd[j] = (next - body.q[j]) / dt;
      body.q[j] = next;
    }
  }

  /// Moves the joints that follow others, and the free joints of loops. Springs have no effect.
  static void move_mechanisms(Body& body, double dt) {
    if (body.machine.gears.empty() && body.machine.loops.empty()) return;
    // From the last step's positions, the loops are nearly closed.
    constexpr int kMost = 10;
    std::vector<char> held(body.q.size());
    for (std::size_t j = 0; j < held.size(); ++j)
      held[j] = body.input[j].mode != JointMode::kFree || body.braked[j] != 0 ? 1 : 0;
    std::vector<double> q = body.q;
    scene::close_loops(body.machine, held, q, kMost);
    for (std::size_t j = 0; j < q.size(); ++j) {
      body.qd[j] += (q[j] - body.q[j]) / dt;
      body.q[j] = q[j];
    }
  }

  /// Returns the motion of this step: by the drive, or by the spin and steering of its wheels where
  /// joint commands have taken any over. Turns the wheels that the drive moves.
  static Roll move_wheels(Body& body, double dt) {
    const Roll commanded = body.line->roll(body.drive);
    std::vector<WheelMotion> motion(body.machine.wheels.size());
    bool any_taken = false;
    for (std::size_t w = 0; w < motion.size(); ++w) {
      const scene::Wheel& wheel = body.machine.wheels[w];
      const int spin = body.machine.joint_index(wheel.joint),
                turn = body.machine.joint_index(wheel.steer_joint);
      if (spin >= 0) {
        if (body.taken[index(spin)] == 0 && body.wheels[w].driven)
          turn_wheel(body, w, spin, commanded, dt);
        any_taken |= body.taken[index(spin)] != 0 && body.wheels[w].driven;
        motion[w].spin = body.qd[index(spin)];
      }
      if (turn < 0) continue;
      // Steered joints follow at their own rate in the next step; the base is on its arc at once.
      const auto angle = body.line->steer_angle(body.drive, body.wheels[w]);
      if (angle && body.taken[index(turn)] == 0)
        body.input[index(turn)] = {JointMode::kPosition, *angle};
      any_taken |= body.taken[index(turn)] != 0;
      motion[w].steer = body.q[index(turn)];
    }
    const Roll roll = any_taken ? body.line->rolled(motion) : commanded;
    // The other wheels roll along.
    for (std::size_t w = 0; w < motion.size(); ++w) {
      const int spin = body.machine.joint_index(body.machine.wheels[w].joint);
      if (spin >= 0 && body.taken[index(spin)] == 0 && !body.wheels[w].driven)
        turn_wheel(body, w, spin, roll, dt);
    }
    return roll;
  }
  /// Rolls wheel `w` on joint `spin` along; its joint belongs to the drive.
  static void turn_wheel(Body& body, std::size_t w, int spin, const Roll& roll, double dt) {
    body.qd[index(spin)] = body.line->rolling_spin(roll, body.wheels[w]);
    body.q[index(spin)] += dt * body.qd[index(spin)];
    body.input[index(spin)] = {JointMode::kFree, 0};
  }

  /// Moves the base without slip along the arc of drive or wheels, on the ground under its origin.
  static void move_base(Body& body, const GroundQuery& ground, double dt) {
    const Roll roll = move_wheels(body, dt);
    const double speed = roll.speed, rate = roll.yaw_rate;
    // Only the heading of the base is kept; it is set upright below.
    const double yaw = std::atan2(body.X_WB.linear()(1, 0), body.X_WB.linear()(0, 0));
    // Heading at the midpoint: the arc's chord up to third order in the step.
    const double mean = yaw + 0.5 * rate * dt;
    const Vec3 p = body.X_WB.translation();
    Vec3 next(p.x() + dt * speed * std::cos(mean), p.y() + dt * speed * std::sin(mean), 0);
    // Upright on the ground under its origin; it does not lean with a slope.
    next.z() = ground.height(next.x(), next.y());
    body.v_W = (next - p) / dt;
    body.w_W = Vec3(0, 0, rate);
    body.X_WB = make_pose(next.x(), next.y(), next.z(), 0, 0, yaw + rate * dt);
  }

  /// Moves the base by its share of the remaining distance, so that it arrives on time. It turns
  /// through the smaller angle.
  static void move_to_goal(Body& body, double dt) {
    // dt / time left, of what remains, is a constant velocity; the last step takes all that is
    // left.
    const double share = body.left > dt ? dt / body.left : 1;
    body.left = std::max(0.0, body.left - dt);
    const Vec3& to = body.goal.angles;
    const Pose goal =
        make_pose(body.goal.p_W.x(), body.goal.p_W.y(), body.goal.p_W.z(), to.x(), to.y(), to.z());
    const Eigen::AngleAxisd turn(Mat3(goal.linear() * body.X_WB.linear().transpose()));
    const Vec3 step = share * (goal.translation() - body.X_WB.translation());
    body.v_W = step / dt;
    body.w_W = share * turn.angle() / dt * turn.axis();
    if (share == 1) {
      body.X_WB = goal;
      return;
    }
    body.X_WB.translation() += step;
    body.X_WB.linear() = Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix() *
                         body.X_WB.linear();
  }

  static void update_links(Body& body) {
    // Poses of all links first, then velocities outward from the base by each joint's rate.
    const std::vector<Pose> poses = forward_kinematics(body.machine, body.X_WB, body.q);
    body.links.assign(poses.size(), LinkState{});
    std::vector<char> known(poses.size(), 0);
    known[0] = 1;
    body.links[0] = {body.X_WB, body.v_W, body.w_W};
    // Joints may be in any order, so passes go on until no further link is reached.
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t j = 0; j < body.machine.joints.size(); ++j) {
        const scene::Joint& joint = body.machine.joints[j];
        if (joint.parent < 0 || !known[index(joint.parent)] || known[index(joint.child)]) continue;
        const LinkState& parent = body.links[index(joint.parent)];
        LinkState& child = body.links[index(joint.child)];
        child.X_WL = poses[index(joint.child)];
        // The joint's axis and origin in W; the pivot moves with the parent.
        const Vec3 axis = (child.X_WL * joint.X_LcJ).linear() * joint.axis.normalized();
        const Vec3 pivot = child.X_WL * Vec3(joint.X_LcJ.translation());
        child.w_WL = parent.w_WL;
        Vec3 v_pivot = parent.v_WL + parent.w_WL.cross(pivot - parent.X_WL.translation());
        if (joint.type == scene::Joint::Type::kRevolute) child.w_WL += body.qd[j] * axis;
        if (joint.type == scene::Joint::Type::kPrismatic) v_pivot += body.qd[j] * axis;
        child.v_WL = v_pivot + child.w_WL.cross(child.X_WL.translation() - pivot);
        known[index(joint.child)] = 1;
        grown = true;
      }
    }
  }

  std::vector<Body> bodies_;
};

}  // namespace

std::unique_ptr<PhysicsEngine> make_kinematic_engine() {
  return std::make_unique<KinematicEngine>();
}

}  // namespace navvy::vehicle
