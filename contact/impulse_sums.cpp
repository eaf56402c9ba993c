#include "contact/impulse_sums.hpp"

#include "contact/scene.hpp"
#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

void ImpulseSums::add(const ContactScene& scene, std::size_t nodes, double step) {
  duration_ += step;
  place_.resize(nodes, -1);
  scene.pushed.for_each([&](std::size_t s) {
    const int node = scene.surface.node[s];
    if (node < 0) return;
    int& place = place_[index(node)];
    if (place < 0) {
      place = static_cast<int>(sum_.size());
      sum_.push_back({.node = node});
    }
    OfNode& sum = sum_[index(place)];
    sum.normal = sum.normal + scene.normal_impulse[s];
    sum.friction = sum.friction + scene.friction_impulse[s];
  });
}

void ImpulseSums::begin_interval() {
  for (const OfNode& one : sum_) place_[index(one.node)] = -1;
  sum_.clear();
  duration_ = 0;
}

}  // namespace brio
