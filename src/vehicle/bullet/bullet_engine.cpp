// SPDX-License-Identifier: Apache-2.0
// Bullet engine: machines as multibodies in one collision world.
//
// The step is assembled here instead of in btMultiBodyDynamicsWorld: there are no islands, no
// contact outlives its step, and sleep is state (rest.h), so a step depends on the saved state
// alone.
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>

#include <cmath>
#include <string>
#include <utility>

#include "core/error.h"
#include "vehicle/body_contact.h"
#include "vehicle/bullet/broad_phase.h"
#include "vehicle/bullet/bullet_machine.h"
#include "vehicle/bullet/contact_list.h"
#include "vehicle/bullet/contact_materials.h"
#include "vehicle/bullet/convert.h"
#include "vehicle/bullet/ground_shape.h"
#include "vehicle/bullet/hitch_rows.h"
#include "vehicle/bullet/lost_machine.h"
#include "vehicle/bullet/mover.h"
#include "vehicle/bullet/refuse.h"
#include "vehicle/bullet/swept_contacts.h"
#include "vehicle/bullet/tyre_bodies.h"

namespace navvy::vehicle {
namespace {

// Moving bodies collide with the ground, with fixed bodies and with each other; fixed bodies with
// nothing else.
constexpr int kGroundGroup = 1, kMachineGroup = 2, kStandingGroup = 4;
constexpr int kIterations = 60;     // tuned: BulletEngine.HoldTorqueMatchesTheClosedForm
constexpr double kResidual = 1e-8;  // [(N s)^2] the solver may stop early below
// Links with shapes of all machines together; 130 bytes each.
constexpr int kMostShapes = 16384;
// Depth below the surface [m] at which a machine has fallen through: no ground is as thick above a
// body.
constexpr double kLost = 10;
constexpr std::uint32_t kVersion = 8;

/// Contacts and pairs of bodies for which Bullet reserves memory when a world is made; it allocates
/// further ones singly. Its own 4096 take megabytes and a seventh of the time to make a world.
constexpr int kReserved = 256;

btDefaultCollisionConstructionInfo reserved_memory() {
  btDefaultCollisionConstructionInfo out;
  out.m_defaultMaxPersistentManifoldPoolSize = kReserved;
  out.m_defaultMaxCollisionAlgorithmPoolSize = kReserved;
  return out;
}

/// Hitch with its two machines.
struct Coupled {
  BulletMachine* parent;
  BulletMachine* child;
  std::unique_ptr<HitchRows> rows;

  /// Wakes both machines: a sleeping towed machine would not be held.
  void keep_awake() const {
    if (!rows->closed()) return;
    parent->disturb();
    child->disturb();
  }
};

/// Filters pairs by their groups, and excludes coupled machines, whose drawbars overlap.
class OverlapFilter final : public btOverlapFilterCallback {
 public:
  explicit OverlapFilter(const std::vector<Coupled>& hitches) : hitches_(hitches) {}
  bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
    if ((a->m_collisionFilterGroup & b->m_collisionFilterMask) == 0 ||
        (b->m_collisionFilterGroup & a->m_collisionFilterMask) == 0)
      return false;
    const void* one = static_cast<const btCollisionObject*>(a->m_clientObject)->getUserPointer();
    const void* other = static_cast<const btCollisionObject*>(b->m_clientObject)->getUserPointer();
    for (const Coupled& hitch : hitches_)
      if (hitch.rows->closed() && ((one == hitch.parent && other == hitch.child) ||
                                   (one == hitch.child && other == hitch.parent)))
        return false;
    return true;
  }

 private:
  const std::vector<Coupled>& hitches_;
};

class BulletEngine final : public PhysicsEngine,
                           public ContactCapability,
                           private ObstacleCapability,
                           private HitchCapability,
                           private RockCapability,
                           private TrackCapability,
                           private PowerCapability,
                           private AccountCapability {
 public:
  BulletEngine(const Vec3& gravity, const scene::Materials& materials)
      : gravity_(gravity),
        materials_(materials),
        configuration_(reserved_memory()),
        dispatcher_(&configuration_),
        broadphase_(kMostShapes),
        world_(&dispatcher_, &broadphase_, &configuration_) {
    // Faces of plates and hulls need more than the one deepest contact point that Bullet finds.
    configuration_.setConvexConvexMultipointIterations();
    ground_.setCollisionShape(&ground_shape_);
    ground_.setWorldTransform(btTransform::getIdentity());
    ground_.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
    // Bullet multiplies the friction of both bodies: the machine's alone counts.
    ground_.setFriction(1);
    ground_.setRestitution(0);
    // Two inactive bodies do not collide: a sleeping body costs no ground queries.
    ground_.forceActivationState(ISLAND_SLEEPING);
    world_.addCollisionObject(&ground_, kGroundGroup, kMachineGroup);
    world_.setForceUpdateAllAabbs(false);
    info_.m_numIterations = kIterations;
    info_.m_leastSquaresResidualThreshold = kResidual;
    info_.m_splitImpulse = false;
    // No warm start, no shuffling
    info_.m_solverMode = SOLVER_SIMD | SOLVER_USE_2_FRICTION_DIRECTIONS;
    info_.m_globalCfm = 0;
  }

  ~BulletEngine() override {
    // The world stores bare pointers: remove them before their owners are destroyed.
    for (const auto& machine : machines_)
      for (btMultiBodyLinkCollider* collider : machine->all_colliders())
        world_.removeCollisionObject(collider);
    for (const Mover& mover : movers_)
      for (const auto& body : mover.bodies())
        for (btMultiBodyLinkCollider* collider : body->all_colliders())
          world_.removeCollisionObject(collider);
    world_.removeCollisionObject(&ground_);
  }

  int add_machine(const scene::Machine& machine, const Pose& X_WM) override {
    require_capacity(machine);
    machines_.push_back(std::make_unique<BulletMachine>(machine, X_WM));
    add_shapes(*machines_.back());
    // The order of rows in the solver affects the result: joints, balls, differentials, springs,
    // gears and loops, then rock, by machine.
    for (const auto& servo : machines_.back()->servos())
      if (servo) constraints_.push_back(servo.get());
    for (const auto& ball : machines_.back()->balls()) constraints_.push_back(ball.get());
    for (const auto& differential : machines_.back()->differentials())
      constraints_.push_back(differential.get());
    for (const auto& spring : machines_.back()->springs()) constraints_.push_back(spring.get());
    if (MechanismRows* mechanism = machines_.back()->mechanism()) constraints_.push_back(mechanism);
    for (const auto& rock : machines_.back()->rock()) {
      rock->set_height(rock_height_);
      constraints_.push_back(rock.get());
    }
    return static_cast<int>(machines_.size()) - 1;
  }
  int machine_count() const override { return static_cast<int>(machines_.size()); }

  int add_obstacle(const scene::Machine& machine) override {
    require_capacity(machine);
    movers_.emplace_back(machine);
    for (const auto& body : movers_.back().bodies()) add_shapes(*body);
    return static_cast<int>(movers_.size()) - 1;
  }
  void move_obstacle(int mover, const std::vector<LinkState>& links) override {
    Mover& one = movers_.at(static_cast<std::size_t>(mover));
    one.move(links);
    // The world does not update the box of a body at rest.
    for (const auto& body : one.bodies())
      for (btMultiBodyLinkCollider* collider : body->all_colliders())
        world_.updateSingleAabb(collider);
  }

  int add_hitch(const scene::Hitch& hitch, int parent, int child) override {
    hitches_.push_back({&at(parent), &at(child),
                        std::make_unique<HitchRows>(hitch, at(parent).tree(), at(child).tree())});
    constraints_.push_back(hitches_.back().rows.get());
    world_.getPairCache()->setOverlapFilterCallback(&filter_);
    return static_cast<int>(hitches_.size()) - 1;
  }
  void set_hitch(int hitch, bool closed) override {
    hitches_.at(static_cast<std::size_t>(hitch)).rows->set(closed);
  }
  HitchState hitch(int hitch) const override {
    return hitches_.at(static_cast<std::size_t>(hitch)).rows->state();
  }

  void set_joint(int machine, int joint, const JointInput& input) override {
    at(machine).set_joint(joint, input);
  }
  void set_drive(int machine, const DriveInput& input) override { at(machine).set_drive(input); }
  void set_brake(int machine, int joint, bool on) override { at(machine).set_brake(joint, on); }
  DriveInput drive(int machine) const override { return at(machine).drive(); }
  void apply_impulse(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                     const Vec3& p_W) override {
    at(machine).apply_impulse(link, J_W, L_W, p_W, 0);
  }
  void apply_impulse_of_step(int machine, int link, const Vec3& J_W, const Vec3& L_W,
                             const Vec3& p_W, double dt) override {
    at(machine).apply_impulse(link, J_W, L_W, p_W, dt);
  }
  void add_force(int machine, int link, const Vec3& f_W, const Vec3& p_W) override {
    at(machine).add_force(link, f_W, p_W);
  }

  void step(double dt, const GroundQuery& ground) override {
    if (!(dt > 0))
      throw SimulationError("vehicle: the step must be positive, it is " + std::to_string(dt));
    for (const Coupled& hitch : hitches_) hitch.keep_awake();
    // Forces and rows first, then contacts at the poses of the step's start, one solve for all,
    // then positions.
    for (auto& machine : machines_) machine->begin_step(ground, dt);
    tyre_bodies_.push(machines_, movers_, world_, dt);
    ground_shape_.set_ground(&ground);
    detect(ground, dt);
    turn_ground_contacts();
    ground_shape_.set_ground(nullptr);
    // Detection uses poses alone. Materials need to know which bodies rest, before forces give all
    // of them a velocity.
    materials_.apply(dispatcher_, ground_, gravity_);
    for (auto& machine : machines_) machine->accelerate(gravity_, dt);
    solve(dt);
    for (const Coupled& hitch : hitches_) hitch.rows->end_step(dt);
    for (auto& machine : machines_) {
      if (machine->asleep()) continue;
      machine->end_step(ground, contact_impulse(*machine), dt);
      // Stop a broken run here, where step and machine are known, before its numbers spread.
      const Vec3 p = machine->tree().center(0);
      if (!p.allFinite() || !machine->tree().momentum().allFinite())
        throw SimulationError("vehicle: machine '" + machine->scene().name +
                              "' has no finite pose" + cause(*machine));
      if (machine->tree().fixed_base() || !(p.z() < ground.height(p.x(), p.y()) - kLost)) continue;
      const std::string why = cause(*machine);
      throw SimulationError(
          "vehicle: machine '" + machine->scene().name + "' has fallen through the ground at x " +
          std::to_string(p.x()) + " m, y " + std::to_string(p.y()) + " m" +
          (why.empty() ? "; it needs wheels or collision shapes that start above the ground"
                       : why));
    }
    contact_list_.collect(world_, machines_, movers_, dt);
    forget_contacts();
  }
  const std::vector<BodyContact>& body_contacts() const override {
    return contact_list_.contacts();
  }

  void set_rock(double height) override {
    rock_height_ = height;
    for (auto& machine : machines_)
      for (const auto& rock : machine->rock()) rock->set_height(height);
  }

  JointState joint(int machine, int joint) const override { return at(machine).joint(joint); }
  LinkState link(int machine, int link) const override { return at(machine).tree().link(link); }
  WheelState wheel(int machine, int wheel) const override { return at(machine).wheel(wheel); }
  std::vector<terramechanics::TrackPatch> track_patches(int machine, int wheel) const override {
    return at(machine).track_patches(wheel);
  }
  Vec3 rock_impulse(int machine, int shell) const override {
    return at(machine).rock_impulse(shell);
  }
  PumpState pump(int machine) const override { return at(machine).pump(); }
  CombustionEngineState drive_engine(int machine) const override { return at(machine).engine(); }
  Mat6 inverse_mass(int machine, int link) const override {
    return at(machine).tree().inverse_mass(link);
  }
  Vec3 momentum(int machine) const override { return at(machine).tree().momentum(); }
  double work(int machine) const override { return at(machine).work(); }
  Vec3 ground_impulse(int machine) const override { return at(machine).ground_impulse(); }
  Vec3 external_impulse(int machine) const override { return at(machine).external_impulse(); }

  ObstacleCapability* obstacles() override { return this; }
  HitchCapability* hitches() override { return this; }
  RockCapability* rock() override { return this; }
  const TrackCapability* tracks() const override { return this; }
  const PowerCapability* power() const override { return this; }
  const AccountCapability* accounts() const override { return this; }

  void visit(Archive& a) override {
    a.section("bullet", kVersion, [&] {
      a.constant("machines", machines_.size(),
                 "the snapshot has another number of machines than the scene");
      for (std::size_t m = 0; m < machines_.size(); ++m) a.item(m, [&] { machines_[m]->visit(a); });
      tyre_bodies_.visit(a, machines_, movers_);
      for (std::size_t h = 0; h < hitches_.size(); ++h)
        a.item(h, [&] { hitches_[h].rows->visit(a); });
    });
    // A step does not update the boxes of inactive bodies.
    if (a.loading())
      for (const auto& machine : machines_)
        for (btMultiBodyLinkCollider* collider : machine->all_colliders())
          world_.updateSingleAabb(collider);
  }

 private:
  BulletMachine& at(int machine) { return *machines_.at(static_cast<std::size_t>(machine)); }
  const BulletMachine& at(int machine) const {
    return *machines_.at(static_cast<std::size_t>(machine));
  }

  void require_capacity(const scene::Machine& machine) const {
    if (world_.getNumCollisionObjects() +
            static_cast<int>(machine.links.size() + machine.shells.size()) >
        kMostShapes)
      refuse("machine[" + machine.name + "]", std::to_string(machine.links.size()) + " links",
             "a world holds at most " + std::to_string(kMostShapes) + " links of all machines");
  }
  /// Adds the shapes of links and the plates of shells to the world.
  void add_shapes(BulletMachine& machine) {
    const auto& colliders = machine.colliders();
    for (std::size_t l = 0; l < colliders.size(); ++l) {
      if (!colliders[l]) continue;
      const bool stands = l == 0 && machine.tree().fixed_base();
      world_.addCollisionObject(
          colliders[l].get(), stands ? kStandingGroup : kMachineGroup,
          stands ? kMachineGroup : kGroundGroup | kMachineGroup | kStandingGroup);
    }
    for (const auto& plates : machine.steel()) {
      const bool stands = plates->m_link < 0 && machine.tree().fixed_base();
      world_.addCollisionObject(plates.get(), stands ? kStandingGroup : kMachineGroup,
                                stands ? kMachineGroup : kMachineGroup | kStandingGroup);
    }
    materials_.mark(machine);
  }

  /// Returns the likely cause of a machine that the engine lost.
  std::string cause(const BulletMachine& machine) const {
    return cause_of_loss(machine, contact_list_.load_on(machine));
  }

  void solve(double dt) {
    // One group for the whole world: no islands, so results do not depend on neighbours.
    info_.m_timeStep = dt;
    for (auto& machine : machines_) machine->tree().multibody().setCompanionId(-1);
    for (const Mover& mover : movers_)
      for (const auto& body : mover.bodies()) body->tree().multibody().setCompanionId(-1);
    btAlignedObjectArray<btCollisionObject*>& objects = world_.getCollisionObjectArray();
    const int manifolds = dispatcher_.getNumManifolds();
    solver_.solveMultiBodyGroup(
        &objects[0], objects.size(),
        manifolds > 0 ? dispatcher_.getInternalManifoldPointer() : nullptr, manifolds, nullptr, 0,
        constraints_.data(), static_cast<int>(constraints_.size()), info_, nullptr, &dispatcher_);
  }

  /// Detects all contacts of this step. A body that wakes has neighbours and ground of its own, so
  /// pairs are searched again.
  void detect(const GroundQuery& ground, double dt) {
    world_.updateAabbs();
    swept_.stretch_boxes(world_, dt);
    do world_.computeOverlappingPairs();
    while (wake_neighbours());
    dispatcher_.dispatchAllCollisionPairs(broadphase_.getOverlappingPairCache(),
                                          world_.getDispatchInfo(), &dispatcher_);
    swept_.add(world_, dispatcher_, ground_, ground_shape_, ground, dt);
  }
  /// Wakes sleeping bodies whose box overlaps an active one's. Returns whether there were any.
  bool wake_neighbours() {
    bool woken = false;
    const btBroadphasePairArray& pairs =
        broadphase_.getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); ++i) {
      const auto* one = static_cast<const btCollisionObject*>(pairs[i].m_pProxy0->m_clientObject);
      const auto* other = static_cast<const btCollisionObject*>(pairs[i].m_pProxy1->m_clientObject);
      if (one->isActive() == other->isActive()) continue;
      if (other->isActive()) std::swap(one, other);
      // Fixed bodies do not wake, and the ground is no machine.
      auto* machine = static_cast<BulletMachine*>(other->getUserPointer());
      if (machine == nullptr || !machine->asleep()) continue;
      machine->wake(static_cast<const BulletMachine*>(one->getUserPointer())->still());
      woken = true;
    }
    return woken;
  }

  /// Gives each contact with the ground a normal of the ground itself.
  void turn_ground_contacts() {
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(i);
      const bool second = manifold->getBody1() == &ground_;
      if (!second && manifold->getBody0() != &ground_) continue;
      for (int p = 0; p < manifold->getNumContacts(); ++p) {
        btManifoldPoint& point = manifold->getContactPoint(p);
        // Bullet's normal points from its body 1 to its body 0.
        const double sign = second ? 1 : -1;
        const Vec3 p_W =
            to_eigen(second ? point.getPositionWorldOnB() : point.getPositionWorldOnA());
        point.m_normalWorldOnB =
            to_bt(Vec3(sign * ground_shape_.outward(p_W, sign * to_eigen(point.m_normalWorldOnB))));
      }
    }
  }

  /// Returns the impulse of the ground on a machine's shapes in this step [N s].
  Vec3 contact_impulse(BulletMachine& machine) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      const btPersistentManifold* manifold = dispatcher_.getManifoldByIndexInternal(i);
      // Bullet's normal points towards its body 0; the sign depends on which of the two is the
      // ground.
      const bool first = manifold->getBody1() == &ground_;
      if (!first && manifold->getBody0() != &ground_) continue;
      const auto* body =
          btMultiBodyLinkCollider::upcast(first ? manifold->getBody0() : manifold->getBody1());
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
    swept_.drop(dispatcher_);
    // This also removes the warm start, which is disabled, see the top.
    btOverlappingPairCache* cache = broadphase_.getOverlappingPairCache();
    while (cache->getNumOverlappingPairs() > 0) {
      btBroadphasePair& pair =
          cache->getOverlappingPairArray()[cache->getNumOverlappingPairs() - 1];
      cache->removeOverlappingPair(pair.m_pProxy0, pair.m_pProxy1, &dispatcher_);
    }
  }

  Vec3 gravity_;
  ContactMaterials materials_;
  // Each member needs the ones before it.
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  SweepBroadphase broadphase_;
  btCollisionWorld world_;
  btMultiBodyConstraintSolver solver_;
  btContactSolverInfo info_;
  GroundShape ground_shape_;
  btCollisionObject ground_;
  TyreBodies tyre_bodies_;
  ContactList contact_list_;
  SweptContacts swept_;
  std::vector<std::unique_ptr<BulletMachine>> machines_;
  std::vector<Mover> movers_;
  std::vector<Coupled> hitches_;
  OverlapFilter filter_{hitches_};
  std::vector<btMultiBodyConstraint*> constraints_;
  double rock_height_ = -1e6;  // far below, until set
};

}  // namespace

std::unique_ptr<PhysicsEngine> make_bullet_engine(const Vec3& gravity,
                                                  const scene::Materials& materials) {
  return std::make_unique<BulletEngine>(gravity, materials);
}

}  // namespace navvy::vehicle
