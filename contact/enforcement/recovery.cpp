#include "contact/enforcement/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

namespace {

/// Of the gap. Less than this is what iterations move to and fro; opened in proportion, it feeds slow
/// vibrations of what rests.
constexpr double sunk_share = 0.3;
/// Of what was taken, in a step: opening raises the load by as much as is not known ahead.
constexpr double returned_share = 0.1;
/// Of the smallest edge: from there on an overlap is deep.
constexpr double deep_overlap_share = 0.1;

// `visit(slave, share of the contact)`
template <class Visit>
void each_node(const Contact& contact, Visit&& visit) {
  for (std::size_t k = 0; k < contact.node.size(); ++k)
    if (contact.weight[k] != 0) visit(contact.node[k], 0.5 * std::abs(contact.weight[k]));
}

}  // namespace

Recovery recovery_of(const ContactOptions& options, double smallest_edge, double gap, double of_step) {
  return {of_step * options.overlap_recovery, deep_overlap_share * smallest_edge,
          of_step * options.overlap_recovery_cap * smallest_edge, sunk_share * gap};
}

double target_velocity(const Recovery& recovery, double gap, double impulse, double mass, double returned,
                       double dt) {
  if (gap >= 0) return -gap / dt;
  if (!(impulse > 0)) return 0;
  const double share = recovery.share * (-gap < recovery.deep ? -gap / recovery.deep : 1);
  const double unloaded = std::min(share * -gap, recovery.cap) / dt;
  const double gain = mass * unloaded;
  const double opened = impulse > gain ? unloaded * (gain / impulse) : unloaded;
  return std::max(opened, std::min(recovery.cap / dt, returned));
}

void LoadedNodes::resize(std::size_t slaves) {
  node_.resize(slaves);
  loaded_.resize(slaves);
  of_step_.resize(slaves);
}

void LoadedNodes::add(const Contact& contact, double work) {
  each_node(contact, [&](int slave, double share) {
    of_step_.insert(slave);
    node_[index(slave)].impulse_of_step += share * contact.impulse;
    node_[index(slave)].work_of_step += share * work;
  });
}

void LoadedNodes::end_step() {
  of_step_.for_each([&](std::size_t s) {
    Node& node = node_[s];
    const double taken = node.impulse > 0 ? -node.work_of_step : 0;
    node = {node.taken + taken, node.impulse_of_step};
    taken_ += taken;
  });
  loaded_.for_each([&](std::size_t s) {
    if (of_step_.contains(static_cast<int>(s))) return;
    taken_ -= std::max(node_[s].taken, 0.0);
    node_[s] = {};
  });
  std::swap(loaded_, of_step_);
  of_step_.clear();
}

double LoadedNodes::velocity_returning_all(const Contact& contact) const {
  double taken = 0;
  double impulse = 0;
  each_node(contact, [&](int slave, double share) {
    taken += share * node_[index(slave)].taken;
    impulse += share * node_[index(slave)].impulse;
  });
  return taken > 0 && impulse > 0 ? taken / impulse : 0;
}

std::span<const double> LoadedNodes::opening_velocities(std::span<const Contact> contacts,
                                                        const Recovery& recovery, double dt) {
  velocity_.clear();
  double work = 0;
  for (const Contact& contact : contacts) {
    const double sunk = -contact.gap - recovery.sunk;
    const double velocity = sunk > 0 && contact.impulse > 0
                                ? std::min(velocity_returning_all(contact), recovery.share * sunk / dt)
                                : 0;
    velocity_.push_back(velocity);
    work += velocity * contact.impulse;
  }
  const double returned = returned_share * std::max(taken_, 0.0);
  if (work > returned)
    for (double& velocity : velocity_) velocity *= returned / work;
  return velocity_;
}

}  // namespace brio
