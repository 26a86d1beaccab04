// SPDX-License-Identifier: Apache-2.0
#include "vehicle/bullet/bullet_machine.h"

#include <algorithm>

#include "vehicle/bullet/convert.h"
#include "vehicle/bullet/refuse.h"

namespace navvy::vehicle {
namespace {

// [N/m] tuned: BulletContact.RaisedGroundDoesNotLaunchABody
constexpr double kContactStiffness = 2e7;
constexpr double kContactDamping = 1e7;  // [N s/m] with it: overlap is resolved at 2 per second

}  // namespace

BulletMachine::BulletMachine(const scene::Machine& machine, const Pose& X_WM)
    : machine_(machine),
      tree_(machine_, X_WM),
      joints_(machine_, tree_),
      wheels_(machine_, tree_),
      drive_(machine_, tree_, joints_, wheels_),
      mechanism_(make_mechanism_rows(machine_, tree_)),
      springs_(make_springs(machine_, tree_, mechanism_.get())) {
  for (const auto& servo : joints_.servos())
    if (servo && mechanism_) servo->couple(*mechanism_);
  add_colliders();
  add_rock();
  add_steel();
  place_colliders();
  // Wheels and shells work even at standstill, so such machines never sleep.
  if (!tree_.fixed_base() && machine_.links.size() == 1 && machine_.wheels.empty() &&
      machine_.shells.empty() && colliders_[0])
    rest_.emplace();
}

// One collider per link with shapes.
void BulletMachine::add_colliders() {
  // One compound per link in Bullet's inertial frame; links without collision shapes have none.
  shapes_.resize(machine_.links.size());
  colliders_.resize(machine_.links.size());
  for (std::size_t i = 0; i < machine_.links.size(); ++i) {
    const int link = static_cast<int>(i), k = tree_.bullet_of_link(link);
    shapes_[i] = make_link_shape(machine_.links[i], tree_.inertial_frame(link).inverse(),
                                 i == 0 && tree_.fixed_base());
    if (!shapes_[i].compound) continue;
    auto collider = make_collider(shapes_[i], link);
    // The tree and the world both point to it; this object owns it.
    if (k < 0)
      tree_.multibody().setBaseCollider(collider.get());
    else
      tree_.multibody().getLink(k).m_collider = collider.get();
    colliders_[i] = std::move(collider);
  }
}

std::unique_ptr<btMultiBodyLinkCollider> BulletMachine::make_collider(const LinkShape& shape,
                                                                      int link) {
  auto collider =
      std::make_unique<btMultiBodyLinkCollider>(&tree_.multibody(), tree_.bullet_of_link(link));
  collider->setCollisionShape(shape.compound.get());
  collider->setFriction(shape.friction);
  collider->setRestitution(0);
  // Stiff but not rigid: ground that was raised under a body must not launch it.
  collider->setContactStiffnessAndDamping(kContactStiffness, kContactDamping);
  // Read by SweptContacts alone: the engine does not use Bullet's own continuous detection.
  btVector3 low, high;
  shape.compound->getAabb(btTransform::getIdentity(), low, high);
  low = low.absolute();
  low.setMax(high.absolute());
  collider->setCcdSweptSphereRadius(low.length());
  collider->setCcdMotionThreshold(0.5 * shape.thinnest);
  // A fixed body collides only with active ones.
  const bool stands = tree_.fixed_base() && link == 0;
  collider->forceActivationState(stands ? ISLAND_SLEEPING : DISABLE_DEACTIVATION);
  return collider;
}

void BulletMachine::add_steel() {
  for (const scene::Shell& shell : machine_.shells) {
    plates_.push_back(make_steel(shell));
    steel_.push_back(make_collider(plates_.back(), machine_.link_index(shell.link)));
  }
}

std::vector<btMultiBodyLinkCollider*> BulletMachine::all_colliders() const {
  std::vector<btMultiBodyLinkCollider*> out;
  for (const auto* list : {&colliders_, &steel_})
    for (const auto& collider : *list)
      if (collider) out.push_back(collider.get());
  return out;
}

// The tree moves its links' own colliders; move the plates of shells here.
void BulletMachine::place_colliders() {
  tree_.place_colliders();
  for (const auto& plates : steel_)
    plates->setWorldTransform(to_bt(tree_.link(link_of(*plates)).X_WL));
}

void BulletMachine::add_rock() {
  for (const scene::Shell& shell : machine_.shells) {
    const int link = machine_.link_index(shell.link);
    if (link < 0) refuse("shell[" + shell.name + "]", shell.link, "no link of this name");
    // Every corner of a shell may touch the rock.
    rock_.push_back(std::make_unique<RockContact>(tree_, link, shell.vertices));
  }
}

void BulletMachine::set_joint(int joint, const JointInput& input) {
  Actuator& actuator = joints_[joint];
  // Taken from the drive until its next command.
  actuator.servo.set(input);
  actuator.driven = false;
}

void BulletMachine::add_force(int link, const Vec3& f_W, const Vec3& p_W) {
  disturb();
  pushes_.push_back({link, f_W, p_W});
}

void BulletMachine::apply_impulse(int link, const Vec3& J_W, const Vec3& L_W, const Vec3& p_W,
                                  double dt) {
  disturb();
  if (tree_.apply_impulse(link, J_W, L_W, p_W, dt)) place_colliders();
  external_impulse_ += J_W;
}

// Bullet ignores pairs of two inactive bodies; fixed bodies are inactive, too.
void BulletMachine::set_active(bool active) {
  colliders_[0]->forceActivationState(active ? DISABLE_DEACTIVATION : ISLAND_SLEEPING);
}

void BulletMachine::wake(double still) {
  if (!asleep()) return;
  rest_->wake(still);
  set_active(true);
}

void BulletMachine::disturb() {
  if (!rest_) return;
  rest_->disturb();
  set_active(true);
}

void BulletMachine::move_base(const LinkState& link) {
  const bool still = link.v_WL.isZero(0) && link.w_WL.isZero(0);
  tree_.set_base(link);
  // Tyre forces on it have no effect.
  tree_.multibody().clearForcesAndTorques();
  place_colliders();
  for (btMultiBodyLinkCollider* collider : all_colliders())
    collider->forceActivationState(still ? ISLAND_SLEEPING : DISABLE_DEACTIVATION);
}

void BulletMachine::box(btVector3& low, btVector3& high) const {
  colliders_[0]->getCollisionShape()->getAabb(colliders_[0]->getWorldTransform(), low, high);
}

// Sleeping machines only check whether their ground has changed.
void BulletMachine::begin_step(const GroundQuery& ground, double dt) {
  if (asleep()) {
    btVector3 low, high;
    box(low, high);
    rest_->feel(ground, low, high);
    if (rest_->asleep()) return;
    set_active(true);
  }
  joints_.note_speeds();
  // The drive commands joints, so it comes first. The tree sums forces, which may come in any
  // order.
  drive_.begin_step(dt);
  joints_.begin_step(dt);
  tyre_impulse_ = wheels_.push(ground, dt);
  for (const Push& push : pushes_) {
    tree_.add_force(push.link, push.f_W, Vec3::Zero(), push.p_W);
    external_impulse_ += dt * push.f_W;
  }
  pushes_.clear();
}

void BulletMachine::accelerate(const Vec3& gravity, double dt) {
  if (asleep())
    // The ground carries the weight of a sleeping body.
    ground_impulse_ = -dt * tree_.total_mass() * gravity;
  else
    tree_.step_velocities(gravity, dt);
  if (mechanism_) mechanism_->prepare(dt);
}

// Reads the solver's impulses in the order in which the parts depend on each other.
void BulletMachine::end_step(const GroundQuery& ground, const Vec3& contact, double dt) {
  // Sum of all ground and rock impulses of this step.
  ground_impulse_ = tyre_impulse_ + contact;
  for (const auto& rock : rock_) {
    rock->settle();
    ground_impulse_ += rock->impulse();
  }
  // Read rows before positions change: their impulses belong to the poses of the step's start.
  tree_.step_positions(dt);
  place_colliders();
  drive_.end_step(dt);
  joints_.end_step(dt);
  if (!rest_) return;
  if (!rest_->tire(tree_.link(0).X_WL, dt)) return;
  tree_.stop();
  set_active(false);
  btVector3 low, high;
  box(low, high);
  rest_->lie_down(ground, low, high);
}

WheelState BulletMachine::wheel(int wheel) const {
  WheelState state = wheels_.state(wheel);
  state.shaft_torque = drive_.shaft_torque(wheel);
  return state;
}

void BulletMachine::Push::visit(Archive& a) {
  a("link", link);
  a("f_W", f_W);
  a("p_W", p_W);
}

/// Visits the tree first: other parts follow from its positions on loading.
void BulletMachine::visit(Archive& a) {
  a("tree", tree_);
  a("joints", joints_);
  a.fixed("wheels", wheels_.all());
  a("drive", drive_);
  for (std::size_t r = 0; r < rock_.size(); ++r) a.item(r, [&] { a("rock", *rock_[r]); });
  // Set between two steps, to act in the next.
  a("pushes", pushes_);
  const auto links = static_cast<int>(machine_.links.size());
  a.require(std::all_of(pushes_.begin(), pushes_.end(),
                        [&](const Push& p) { return p.link >= 0 && p.link < links; }),
            "pushes", "the machine has no such link");
  a("ground_impulse", ground_impulse_);
  a("external_impulse", external_impulse_);
  if (rest_) a("rest", *rest_);
  if (!a.loading()) return;
  place_colliders();
  if (rest_) set_active(!rest_->asleep());
}

}  // namespace navvy::vehicle
