#include "src/fields/contact_fields.hpp"

#include <algorithm>
#include <limits>

#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
/// A force that is as good as parallel to all faces at a node has no area.
constexpr double least_area_share = 1e-6;

void mean_force(const Model& model, int node, double* out) {
  const ImpulseSums::OfNode* sum = model.impulse_sums.of(node);
  const Vector3d mean =
      sum == nullptr ? Vector3d{} : (sum->normal + sum->friction) / model.impulse_sums.duration();
  std::copy_n(mean.data(), 3, out);
}

void mean_pressure(const Model& model, int node, double* out) {
  *out = not_a_number;
  const Surface& surface = model.contacts.front().surface;
  const int slave = surface.slave(node);
  if (slave < 0 || surface.faces_of.of(slave).empty()) return;
  *out = 0;
  const ImpulseSums::OfNode* sum = model.impulse_sums.of(node);
  const double impulse = sum == nullptr ? 0 : norm(sum->normal);
  if (impulse == 0) return;
  double all = 0;
  const double area = pushed_area(surface, model.nodes, slave, sum->normal / impulse, all);
  *out = area > least_area_share * all ? impulse / (model.impulse_sums.duration() * area) : not_a_number;
}

void least_gap(const Model& model, int node, double* out) {
  const ContactScene& scene = model.contacts.front();
  *out = not_a_number;
  const int slave = scene.surface.slave(node);
  if (slave < 0) return;
  // Contacts of nodes and faces, then those of edges, are in the order of their slaves.
  const auto first = std::ranges::lower_bound(scene.contacts, slave, {}, &Contact::slave);
  for (auto one = first; one != scene.contacts.end() && one->slave == slave; ++one)
    *out = one == first ? one->gap : std::min(*out, one->gap);
}

constexpr PointVariable of_force{
    "contact_force", 3,       mean_force,
    false,           "force", "normal and friction force on the node, mean since the last dump"};
constexpr PointVariable of_contact[] = {
    {"contact_pressure", 1, mean_pressure, true, "stress",
     "normal force on the node, mean since the last dump, over the area of its faces as seen along that "
     "force (a quarter of each, a third of a triangle; of solids those that it pushes upon); 0 without "
     "contact, NaN at nodes without faces"},
    {"contact_gap", 1, least_gap, true, "length",
     "least gap of the node to a face that it is near, beyond the contact distance, in the last step; "
     "negative: an overlap; NaN where it is near none"}};

}  // namespace

const PointVariable& contact_force_variable() { return of_force; }
std::span<const PointVariable> contact_variables() { return of_contact; }

double pushed_area(const Surface& surface, const Nodes& nodes, int slave, const Vector3d& direction,
                   double& area) {
  double pushed = 0;
  area = 0;
  for (int f : surface.faces_of.of(slave)) {
    const Face& face = surface.face[index(f)];
    if (!face.alive()) continue;
    const FaceVertices x = vertices(nodes, face);
    const bool is_triangle = face.node[2] == face.node[3];
    const Vector3d own = cross(x[2] - x[0], x[3] - x[1]) / (2 * (is_triangle ? 3 : 4));
    const double along = -dot(own, direction);
    area += norm(own);
    pushed += face.shell ? std::abs(along) : std::max(along, 0.0);
  }
  return pushed;
}

}  // namespace brio
