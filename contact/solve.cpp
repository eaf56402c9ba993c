#include "contact/solve.hpp"

#include <algorithm>
#include <cmath>

#include "contact/held_contact.hpp"
#include "contact/rigid_contact.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

/// The sweeps end early once none changes a relative velocity by more than this share of the largest that an
/// impulse stands for.
constexpr double converged_share = 1e-4;
/// All nodes are held where only rounding of a weight moves the contact: below this share of what its
/// lightest node alone would move.
constexpr double held_share = 1e-20;
/// Contacts whose directions differ by more than 60 degrees do not inherit from each other.
constexpr double inherited_direction = 0.5;

Vector3d relative_velocity(const Contact& contact, std::span<const ContactMotion> motion) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t k = 0; k < 5; ++k) {
    const double* v = motion[static_cast<std::size_t>(contact.node[k])].velocity;
    sum += contact.weight[k] * Vector3d(v[0], v[1], v[2]);
  }
  return sum;
}

void apply(const Contact& contact, const Vector3d& impulse, std::span<ContactMotion> motion) {
  for (std::size_t k = 0; k < 5; ++k) {
    ContactMotion& node = motion[static_cast<std::size_t>(contact.node[k])];
    for (int axis = 0; axis < 3; ++axis)
      node.velocity[axis] += contact.weight[k] * node.inverse_mass[axis] * impulse[axis];
  }
}

double effective_mass(const Contact& contact, const Vector3d& direction,
                      std::span<const ContactMotion> motion) {
  double inverse = 0;
  double lightest = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const ContactMotion& node = motion[static_cast<std::size_t>(contact.node[k])];
    double share = 0;
    for (int axis = 0; axis < 3; ++axis) share += direction[axis] * direction[axis] * node.inverse_mass[axis];
    inverse += contact.weight[k] * contact.weight[k] * share;
    lightest = std::max(lightest, share);
  }
  return inverse > held_share * lightest ? 1 / inverse : 0;
}

// Two unit vectors that complete the normal.
void span_plane(const Vector3d& normal, Vector3d (&tangent)[2]) {
  int smallest = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (std::abs(normal[axis]) < std::abs(normal[smallest])) smallest = axis;
  tangent[0] = Vector3d::Unit(smallest).cross(normal).normalized();
  tangent[1] = normal.cross(tangent[0]);
}

// Shallow overlaps are opened the slower the shallower they are: where impulses lag behind what the sweeps
// have yet to find, opening in proportion to depth integrates the overlap, which feeds slow vibrations of
// what rests. A contact under load is opened the slower the more it carries beyond what a node gains at the
// fastest recovery: pinched between bodies that cannot give way, it would otherwise be opened with any force.
double target_velocity(const ContactOptions& options, const Contact& contact, double deep, double normal_mass,
                       double smallest_edge, double dt) {
  if (contact.gap >= 0) return -contact.gap / dt;
  const double fastest = options.overlap_recovery_cap * smallest_edge / dt;
  const double share = options.overlap_recovery * (-contact.gap < deep ? -contact.gap / deep : 1);
  const double unloaded = std::min(share * -contact.gap / dt, fastest);
  const double gain = normal_mass * fastest;
  return contact.impulse > gain ? unloaded * (gain / contact.impulse) : unloaded;
}

// \returns the change of the relative velocity that was asked for.
template <class Motion>
double push(Contact& contact, const ContactFrame& frame, const Motion& motion) {
  const double missing = frame.target - contact.normal.dot(relative_velocity(contact, motion));
  const double impulse = std::max(0.0, contact.impulse + frame.normal_mass * missing);
  const double change = impulse - contact.impulse;
  if (change == 0) return 0;
  contact.impulse = impulse;
  apply(contact, change * contact.normal, motion);
  return std::abs(change) / frame.normal_mass;
}

template <class Motion>
double rub(Contact& contact, const ContactFrame& frame, double limit, const Motion& motion) {
  const Vector3d slip = relative_velocity(contact, motion);
  double wanted[2];
  for (int t = 0; t < 2; ++t)
    wanted[t] = frame.tangent[t].dot(contact.friction) - frame.tangent_mass[t] * frame.tangent[t].dot(slip);
  const double size = std::sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  const double scale = size > limit ? limit / size : 1;
  const Vector3d impulse = scale * (wanted[0] * frame.tangent[0] + wanted[1] * frame.tangent[1]);
  const Vector3d change = impulse - contact.friction;
  contact.friction = impulse;
  apply(contact, change, motion);
  const double mass = std::max(frame.tangent_mass[0], frame.tangent_mass[1]);
  return mass > 0 ? change.norm() / mass : 0;
}

}  // namespace

void warm_start(std::span<const Contact> last, double step_ratio, std::span<Contact> contacts) {
  std::size_t begin = 0;
  for (Contact& contact : contacts) {
    while (begin < last.size() && last[begin].slave < contact.slave) ++begin;
    const Contact* best = nullptr;
    double closest = inherited_direction;
    for (std::size_t i = begin; i < last.size() && last[i].slave == contact.slave; ++i) {
      const double along = last[i].normal.dot(contact.normal);
      if (last[i].body != contact.body || along <= closest) continue;
      closest = along;
      best = &last[i];
    }
    if (best == nullptr) continue;
    contact.impulse = step_ratio * best->impulse;
    const Vector3d friction = step_ratio * best->friction;
    contact.friction = friction - contact.normal.dot(friction) * contact.normal;
  }
}

namespace {

template <class Motion>
void solve_for(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
               std::span<Contact> contacts, const Motion& motion) {
  solver.frame.resize(contacts.size());
  solver.passes_done = 0;
  solver.residual = 0;
  const bool with_friction = std::any_of(contacts.begin(), contacts.end(), [](const Contact& contact) {
    return contact.friction_coefficient > 0;
  });
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    Contact& contact = contacts[i];
    ContactFrame& frame = solver.frame[i];
    frame.normal_mass = effective_mass(contact, contact.normal, motion);
    frame.target = target_velocity(options, contact, solver.deep_share * smallest_edge, frame.normal_mass,
                                   smallest_edge, dt);
    if (frame.normal_mass == 0) {
      contact.impulse = 0;
      contact.friction.setZero();
    }
    if (with_friction) {
      span_plane(contact.normal, frame.tangent);
      for (int t = 0; t < 2; ++t) frame.tangent_mass[t] = effective_mass(contact, frame.tangent[t], motion);
    }
  }
  for (const Contact& contact : contacts)
    if (contact.impulse > 0) apply(contact, contact.impulse * contact.normal + contact.friction, motion);
  double largest = 0;
  const auto visit = [&](std::size_t i, bool back) {
    const ContactFrame& frame = solver.frame[i];
    if (frame.normal_mass == 0) return;
    Contact& contact = contacts[i];
    double change = back ? 0 : push(contact, frame, motion);
    if (with_friction)
      change = std::max(change, rub(contact, frame, contact.friction_coefficient * contact.impulse, motion));
    if (back) change = std::max(change, push(contact, frame, motion));
    solver.residual = std::max(solver.residual, change);
    largest = std::max(largest, contact.impulse / frame.normal_mass);
  };
  while (solver.passes_done < options.passes && !contacts.empty()) {
    ++solver.passes_done;
    solver.residual = largest = 0;
    for (std::size_t i = contacts.size(); i-- > 0;) visit(i, true);
    if (solver.residual <= converged_share * largest) break;
  }
  // As many forward: the last of them leaves friction within its cone.
  for (int pass = 0; pass < solver.passes_done; ++pass) {
    solver.residual = 0;
    for (std::size_t i = 0; i < contacts.size(); ++i) visit(i, false);
  }
}

}  // namespace

void solve(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
           std::span<Contact> contacts, std::span<ContactMotion> motion) {
  solve_for(solver, options, smallest_edge, dt, contacts, motion);
}

void solve(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
           std::span<Contact> contacts, const MixedMotion& motion) {
  solve_for(solver, options, smallest_edge, dt, contacts, motion);
}

void solve(Solver& solver, const ContactOptions& options, double smallest_edge, double dt,
           std::span<Contact> contacts, const HeldMotion& motion) {
  solve_for(solver, options, smallest_edge, dt, contacts, motion);
}

}  // namespace brio
