#include "contact/erosion.hpp"

#include <algorithm>
#include <cmath>

#include "contact/face_geometry.hpp"
#include "contact/scene.hpp"
#include "src/base/floating_point.hpp"

namespace brio {

using Eigen::Vector3d;

void make_erodible(ContactScene& scene, std::span<const SurfacePart> parts, const Nodes& nodes) {
  scene.erosion.emplace(ContactErosion{.topology = make_topology(scene.surface, parts),
                                       .exclusion = ErodingExclusion(scene.surface, nodes),
                                       .local = {},
                                       .change = {},
                                       .growing = {}});
  scene.erosion->exclusion.keeps_torn = !scene.distance;
  // A mean over fewer shells may be larger than any mean so far.
  double& bound = scene.candidates.radius_bound;
  for (const SurfacePart& part : parts) bound = std::max(bound, part.debris_radius);
  for (double thickness : scene.surface.thickness) bound = std::max(bound, 0.5 * thickness);
}

namespace {

// Debris has its full radius at once: what it is nearer to waits until it has been apart.
void change_features(DistanceContact& distance, Surface& surface, const ContactOptions& options,
                     const SurfaceTopology& topology, const SurfaceChange& change,
                     const std::vector<int>& affected) {
  for (int slave : change.debris)
    if (const int node = surface.node[static_cast<std::size_t>(slave)]; node >= 0)
      surface.radius[static_cast<std::size_t>(slave)] =
          topology.debris[static_cast<std::size_t>(node)].radius;
  std::vector<int> edges, nodes = affected, faces = change.dead_face;
  update(distance.features, surface, options, change, edges);
  nodes.insert(nodes.end(), change.dead_slave.begin(), change.dead_slave.end());
  nodes.insert(nodes.end(), change.new_slave.begin(), change.new_slave.end());
  faces.insert(faces.end(), change.new_face.begin(), change.new_face.end());
  distance.motion.join(distance.features, surface, change.new_slave);
  distance.pairs.change(nodes, faces, edges, change.debris);
}

}  // namespace

void erode(ContactScene& scene, std::span<const SurfaceElement> deleted, const Nodes& nodes,
           ThreadTeam& team) {
  if (deleted.empty()) return;
  ContactErosion& erosion = *scene.erosion;
  Surface& surface = scene.surface;
  // What the last search found knows the dead of before no more.
  const std::uint64_t searches =
      scene.distance ? scene.distance->pairs.searches() : scene.candidates.counts.searches;
  if (erosion.search != searches) {
    erosion.search = searches;
    if (!erosion.keeps_numbers) erosion.topology.faces.release();
    erosion.topology.slaves.release();
  }
  delete_elements(surface, erosion.topology, deleted, erosion.change);
  if (erosion.change.split)
    for (Contact& contact : scene.contacts)
      if (!contact.of_lines()) contact.body = surface.face[static_cast<std::size_t>(contact.face)].body;
  const std::vector<int>& affected =
      erosion.exclusion.mend(scene.excluded, surface, erosion.topology, erosion.change);
  scene.motion.resize(surface.slaves());
  scene.in_contact.resize(surface.slaves());
  scene.pushed.resize(surface.slaves());
  scene.normal_impulse.resize(surface.slaves(), Eigen::Vector3d::Zero());
  scene.friction_impulse.resize(surface.slaves(), Eigen::Vector3d::Zero());
  for (const auto* slaves : {&erosion.change.new_slave, &erosion.change.dead_slave})
    for (int slave : *slaves) {
      scene.normal_impulse[static_cast<std::size_t>(slave)].setZero();
      scene.friction_impulse[static_cast<std::size_t>(slave)].setZero();
    }
  if (scene.distance) {
    change_features(*scene.distance, surface, scene.options, erosion.topology, erosion.change, affected);
    return;
  }
  scene.travel.join(surface, nodes, erosion.change.new_slave);
  erosion.growing.insert(erosion.growing.end(), erosion.change.debris.begin(), erosion.change.debris.end());
  erosion.local.add(scene.candidates, surface, scene.excluded, scene.options, nodes, erosion.change, team);
}

void release_torn_pairs(ContactScene& scene, const Nodes& nodes, ThreadTeam& team) {
  std::erase_if(scene.erosion->exclusion.torn, [&](const std::pair<int, int>& pair) {
    const auto [node, f] = pair;
    const Face& face = scene.surface.face[static_cast<std::size_t>(f)];
    const int slave = scene.surface.slave(node);
    if (slave < 0 || !face.alive()) return true;
    const double reach = touching_distance(scene.surface, scene.options, f, slave);
    const double squared =
        closest_point_on_quad(position(nodes, node), vertices(nodes, face)).squared_distance;
    if (squared < reach * reach) return false;
    scene.excluded.erase(slave, f);
    if (scene.candidates.growth[0] >= 0) scene.erosion->local.add_pair(scene.candidates, slave, f, team);
    return true;
  });
}

namespace {

// How large a radius touches no face; nothing where the node is inside of a body.
double room_around(const ContactScene& scene, const Nodes& nodes, int slave) {
  const double scale = scene.options.shell_thickness_scale;
  const Vector3d x = position(nodes, scene.surface.node[static_cast<std::size_t>(slave)]);
  double room = infinity;
  double nearest = room;
  bool inside = false;
  for (int f : scene.candidates.faces_of.of(slave)) {
    const Face& face = scene.surface.face[static_cast<std::size_t>(f)];
    if (!face.alive()) continue;
    const ClosestPoint closest = closest_point_on_quad(x, vertices(nodes, face));
    const double distance = std::sqrt(closest.squared_distance);
    room = std::min(room, distance / scale - 0.5 * scene.surface.thickness[static_cast<std::size_t>(f)]);
    if (face.shell || distance >= nearest) continue;
    nearest = distance;
    inside = !is_outside(scene.surface, nodes, f, closest);
  }
  return inside ? 0 : room;
}

}  // namespace

void grow_debris(ContactScene& scene, const Nodes& nodes) {
  std::erase_if(scene.erosion->growing, [&](int slave) {
    const auto s = static_cast<std::size_t>(slave);
    double& radius = scene.surface.radius[s];
    const double full =
        scene.erosion->topology.debris[static_cast<std::size_t>(scene.surface.node[s])].radius;
    const double room = std::min(room_around(scene, nodes, slave), full);
    if (room > radius) {
      radius = room;
      scene.candidates.renewed.push_back(slave);
    }
    return radius == full;
  });
}

}  // namespace brio
