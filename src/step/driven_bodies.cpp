#include "src/step/driven_bodies.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include "contact/surface/face_geometry.hpp"
#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Rigid bodies of prescribed motion may overlap by this fraction of the smallest edge: a light touch.
constexpr double driven_overlap = 1e-3;

}  // namespace

void expect_driven_bodies_apart(const Model& model, const ContactScene& scene) {
  if (model.rigid.body.size() < 2) return;
  for (const Contact& contact : scene.contacts) {
    const auto own = index(contact.own);
    const auto node_of = [&](std::size_t k) { return scene.surface.node[index(contact.node[k])]; };
    const int first_body = scene.surface.rigid_body(node_of(0));
    const int second_body = scene.surface.rigid_body(node_of(own));
    if (first_body < 0 || second_body < 0) continue;
    const auto first = index(first_body), second = index(second_body);
    Vector3d point{};
    for (std::size_t k = 0; k < own; ++k) point += contact.weight[k] * position(model.nodes, node_of(k));
    const RigidMotion &a = model.rigid.motion[first], &b = model.rigid.motion[second];
    const Vector3d arm_a = point - a.centre, arm_b = point - b.centre;
    if (a.inverse_mass_along(contact.normal, arm_a) > 0 || b.inverse_mass_along(contact.normal, arm_b) > 0)
      continue;
    const double approach_a = dot(contact.normal, a.velocity_at(arm_a));
    const double approach_b = dot(contact.normal, b.velocity_at(arm_b));
    const double opening = approach_a - approach_b;
    const double gap = contact.gap + model.times.next * opening;
    if (opening >= 0 || gap >= -driven_overlap * scene.features.smallest_edge) continue;
    const bool first_is_faster = std::abs(approach_a) >= std::abs(approach_b);
    const auto name_of = [&](std::size_t body) { return model.parts[model.rigid.body[body].part].name; };
    std::ostringstream text;
    text << "rigid part '" << name_of(first_is_faster ? first : second) << "' is driven into rigid part '"
         << name_of(first_is_faster ? second : first) << "', " << -gap << " deep at time " << model.times.time
         << ": the motion of both is prescribed; end the motion at contact, leave a component of one of them "
            "free, or exclude the pair from contact (contact.pairs, touch: false)";
    throw Breakdown(text.str());
  }
}

}  // namespace brio
