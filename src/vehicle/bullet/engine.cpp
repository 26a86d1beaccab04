// SPDX-License-Identifier: Apache-2.0
// Machines as Bullet multibodies in one collision world.
//
// The step is put together here instead of in btMultiBodyDynamicsWorld: nothing sleeps, no islands are split, and no
// contact outlives its step, so a step depends on the saved state alone.
#include <BulletCollision/BroadphaseCollision/btSimpleBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "vehicle/bullet/convert.h"
#include "vehicle/bullet/machine.h"

namespace navvy::vehicle {
namespace {

// Machines meet the ground and each other; the ground meets nobody else.
constexpr int kGroundGroup = 1, kMachineGroup = 2;
constexpr int kIterations = 60;     // tuned: BulletEngine.HoldTorqueIsTheAnalyticOne
constexpr double kResidual = 1e-8;  // [(N s)^2] solver may stop early below
// The broad phase is a plain list of this size: a few dozen shapes are never worth a tree.
constexpr int kMostShapes = 4096;
constexpr std::uint32_t kVersion = 3;

class BulletEngine final : public Engine {
 public:
  explicit BulletEngine(const Vec3& gravity)
      : gravity_(gravity),
        dispatcher_(&configuration_),
        broadphase_(kMostShapes),
        world_(&dispatcher_, &broadphase_, &configuration_) {
    // Until a patch is given, the ground for bodies is empty space far below.
    patch_ = GroundPatch(2, 2, 1.0, Vec2(-0.5, -0.5), std::vector<float>(4, -1e6f));
    ground_.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    // Bullet multiplies friction of both bodies: the machine's counts alone.
    ground_.setFriction(1);
    ground_.setRestitution(0);
    place_ground();
    world_.addCollisionObject(&ground_, kGroundGroup, kMachineGroup);
    info_.m_numIterations = kIterations;
    info_.m_leastSquaresResidualThreshold = kResidual;
    info_.m_splitImpulse = false;
    info_.m_solverMode = SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;  // no warm start, no shuffling
    info_.m_globalCfm = 0;
  }

  ~BulletEngine() override {
    // The world keeps bare pointers: they leave it before their owners go.
    for (const auto& machine : machines_)
      for (const auto& collider : machine->colliders())
        if (collider) world_.removeCollisionObject(collider.get());
    world_.removeCollisionObject(&ground_);
  }

  int add_machine(const scene::Machine& machine, const Pose& X_WM) override {
    machines_.push_back(std::make_unique<BulletMachine>(machine, X_WM));
    for (const auto& collider : machines_.back()->colliders())
      if (collider) world_.addCollisionObject(collider.get(), kMachineGroup, kGroundGroup | kMachineGroup);
    // The order in which rows are given to the solver is part of the result: joints, then rock, machine by machine.
    for (const auto& servo : machines_.back()->servos())
      if (servo) constraints_.push_back(servo.get());
    for (const auto& rock : machines_.back()->rock()) {
      rock->set_height(rock_height_);
      constraints_.push_back(rock.get());
    }
    return static_cast<int>(machines_.size()) - 1;
  }
  int machine_count() const override { return static_cast<int>(machines_.size()); }

  void set_joint(int machine, int joint, const JointInput& input) override { at(machine).set_joint(joint, input); }
  void set_drive(int machine, const DriveInput& input) override { at(machine).set_drive(input); }
  DriveInput drive(int machine) const override { return at(machine).drive(); }
  void apply_impulse(int machine, int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W) override {
    at(machine).apply_impulse(link, J_W, L_W, p_W);
  }
  void add_force(int machine, int link, const Vec3& f_W, const Vec3& p_W) override {
    at(machine).add_force(link, f_W, p_W);
  }

  void step(double dt, const GroundQuery& ground) override {
    if (!(dt > 0)) throw SimulationError("vehicle: the step must be above zero, it is " + std::to_string(dt));
    // Forces and rows first, then contacts at the poses of the step's start, one solve for all, then positions.
    for (auto& machine : machines_) machine->begin_step(gravity_, ground, dt);
    world_.performDiscreteCollisionDetection();
    solve(dt);
    for (auto& machine : machines_) {
      machine->end_step(contact_impulse(*machine), dt);
      // A broken run stops here, where step and machine are known, before its numbers spread.
      const Vec3 p = machine->tree().center(0);
      if (!p.allFinite() || !machine->tree().momentum().allFinite())
        throw SimulationError("vehicle: machine '" + machine->scene().name + "' has no finite place any more");
    }
    forget_contacts();
  }

  void set_ground_patch(int nx, int ny, double spacing, const Vec2& corner, const std::vector<float>& height) override {
    if (nx < 2 || ny < 2 || !(spacing > 0) ||
        height.size() != static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny))
      throw SimulationError(
          "vehicle: the ground patch needs nx * ny heights, nx and ny at least 2, spacing above zero");
    // A new shape each time: Bullet's heightfield keeps bounds that it never shrinks.
    patch_ = GroundPatch(nx, ny, spacing, corner, height);
    place_ground();
    world_.updateSingleAabb(&ground_);
  }

  void set_rock(double height) override {
    rock_height_ = height;
    for (auto& machine : machines_)
      for (const auto& rock : machine->rock()) rock->set_height(height);
  }

  JointState joint(int machine, int joint) const override { return at(machine).joint(joint); }
  LinkState link(int machine, int link) const override { return at(machine).tree().link(link); }
  WheelState wheel(int machine, int wheel) const override { return at(machine).wheel(wheel); }
  Vec3 rock_impulse(int machine, int shell) const override { return at(machine).rock_impulse(shell); }
  PumpState pump(int machine) const override { return at(machine).pump(); }
  Mat6 inverse_mass(int machine, int link) const override { return at(machine).tree().inverse_mass(link); }
  Vec3 momentum(int machine) const override { return at(machine).tree().momentum(); }
  double work(int machine) const override { return at(machine).work(); }
  Vec3 ground_impulse(int machine) const override { return at(machine).ground_impulse(); }
  Vec3 external_impulse(int machine) const override { return at(machine).external_impulse(); }

  void visit(Archive& a) override {
    a.section("bullet", kVersion, [&] {
      a.constant("machines", machines_.size(), "the snapshot holds another number of machines than the scene");
      for (std::size_t m = 0; m < machines_.size(); ++m) a.item(m, [&] { machines_[m]->visit(a); });
    });
  }

 private:
  BulletMachine& at(int machine) { return *machines_.at(static_cast<std::size_t>(machine)); }
  const BulletMachine& at(int machine) const { return *machines_.at(static_cast<std::size_t>(machine)); }

  void place_ground() {
    ground_.setCollisionShape(patch_.shape.get());
    ground_.setWorldTransform(btTransform(btQuaternion::getIdentity(), to_bt(patch_.center)));
  }

  void solve(double dt) {
    // One group for the whole world: no islands, so nobody's result depends on who is near.
    info_.m_timeStep = dt;
    for (auto& machine : machines_) machine->tree().multibody().setCompanionId(-1);
    btAlignedObjectArray<btCollisionObject*>& objects = world_.getCollisionObjectArray();
    const int manifolds = dispatcher_.getNumManifolds();
    solver_.solveMultiBodyGroup(
        &objects[0], objects.size(), manifolds > 0 ? dispatcher_.getInternalManifoldPointer() : nullptr, manifolds,
        nullptr, 0, constraints_.data(), static_cast<int>(constraints_.size()), info_, nullptr, &dispatcher_);
  }

  /// Impulse of the ground's patch on a machine in this step [N s].
  Vec3 contact_impulse(BulletMachine& machine) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(i);
      // Bullet's normal points towards its body 0; the sign follows from which of the two is the ground.
      const bool first = manifold->getBody1() == &ground_;
      if (!first && manifold->getBody0() != &ground_) continue;
      const auto* body = btMultiBodyLinkCollider::upcast(first ? manifold->getBody0() : manifold->getBody1());
      if (!body || body->m_multiBody != &machine.tree().multibody()) continue;
      for (int p = 0; p < manifold->getNumContacts(); ++p) {
        const btManifoldPoint& point = manifold->getContactPoint(p);
        const btVector3 J = point.m_normalWorldOnB * point.m_appliedImpulse +
                            point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
                            point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
        sum += (first ? 1.0 : -1.0) * to_eigen(J);
      }
    }
    return sum;
  }

  /// Drops every pair and manifold, so that the next step starts from the state alone.
  void forget_contacts() {
    // Without a memory of contacts there is no warm start, and none is wanted: see the top.
    btOverlappingPairCache* cache = broadphase_.getOverlappingPairCache();
    while (cache->getNumOverlappingPairs() > 0) {
      btBroadphasePair& pair = cache->getOverlappingPairArray()[cache->getNumOverlappingPairs() - 1];
      cache->removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &dispatcher_);
    }
  }

  Vec3 gravity_;
  // In the order in which each needs the one before it.
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSimpleBroadphase broadphase_;
  btCollisionWorld world_;
  btMultiBodyConstraintSolver solver_;
  btContactSolverInfo info_;
  GroundPatch patch_;
  btCollisionObject ground_;
  std::vector<std::unique_ptr<BulletMachine>> machines_;
  std::vector<btMultiBodyConstraint*> constraints_;
  double rock_height_ = -1e6;  // far below, until told
};

}  // namespace

std::unique_ptr<Engine> make_bullet_engine(const Vec3& gravity) { return std::make_unique<BulletEngine>(gravity); }

}  // namespace navvy::vehicle
