#include "contact/detection/approach.hpp"

#include <cmath>

#include "contact/search/search.hpp"
#include "src/base/index.hpp"

namespace brio {

bool closes_gap(const Contact& contact, const FeatureMotion& motion, double band) {
  Vector3d relative{};
  for (std::size_t k = 0; k < 5; ++k) relative += contact.weight[k] * motion.displacement(contact.node[k]);
  return contact.gap <= band + approach_factor * std::abs(dot(contact.normal, relative));
}

bool paths_meet(const Contact& contact, const FeatureMotion& motion, double reach, double band) {
  if (contact.gap <= band) return true;
  CaptureBox first = empty_box, second = empty_box;
  for (int k = 0; k < 5; ++k) {
    const int node = contact.node[index(k)];
    const Vector3d step = motion.displacement(node) - vector_at(motion.frame());
    CaptureBox& box = k < contact.own ? first : second;
    box.include(motion.start(node));
    box.include(motion.start(node) + approach_factor * step);
  }
  return grown(first, reach + band).overlaps(second);
}

}  // namespace brio
