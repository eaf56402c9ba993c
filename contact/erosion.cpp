#include "contact/erosion.hpp"

#include "contact/scene.hpp"
#include "src/base/index.hpp"

namespace brio {

void make_erodible(ContactScene& scene, std::span<const SurfacePart> parts, const Nodes& nodes) {
  scene.erosion.emplace(ContactErosion{.topology = make_topology(scene.surface, parts),
                                       .exclusion = ErodingExclusion(scene.surface, nodes),
                                       .change = {}});
}

namespace {

// Debris has its full radius at once: what it is nearer to waits until it has been apart.
void change_features(ContactScene& scene, const std::vector<int>& affected) {
  Surface& surface = scene.surface;
  const SurfaceTopology& topology = scene.erosion->topology;
  const SurfaceChange& change = scene.erosion->change;
  for (int slave : change.debris)
    if (const int node = surface.node[index(slave)]; node >= 0)
      surface.radius[index(slave)] = topology.debris[index(node)].radius;
  std::vector<int> edges, nodes = affected, faces = change.dead_face;
  update(scene.features, surface, scene.options, change, edges);
  nodes.insert(nodes.end(), change.dead_slave.begin(), change.dead_slave.end());
  nodes.insert(nodes.end(), change.new_slave.begin(), change.new_slave.end());
  faces.insert(faces.end(), change.new_face.begin(), change.new_face.end());
  scene.motion.join(scene.features, surface, change, edges);
  scene.pairs.change(nodes, faces, edges, change.debris);
}

}  // namespace

void erode(ContactScene& scene, std::span<const SurfaceElement> deleted) {
  if (deleted.empty()) return;
  ContactErosion& erosion = *scene.erosion;
  Surface& surface = scene.surface;
  // What the last search found knows the dead of before no more.
  if (erosion.search != scene.pairs.searches()) {
    erosion.search = scene.pairs.searches();
    if (!erosion.keeps_numbers) erosion.topology.faces.release();
    erosion.topology.slaves.release();
  }
  delete_elements(surface, erosion.topology, deleted, erosion.change);
  if (erosion.change.split)
    for (Contact& contact : scene.contacts)
      if (!contact.of_edges()) contact.body = surface.face[index(contact.face)].body;
  const std::vector<int>& affected =
      erosion.exclusion.mend(scene.excluded, surface, erosion.topology, erosion.change);
  scene.velocity.resize(surface.slaves(), Vector3d{});
  scene.in_contact.resize(surface.slaves());
  scene.loaded.resize(surface.slaves());
  scene.pushed.resize(surface.slaves());
  scene.normal_impulse.resize(surface.slaves(), Vector3d{});
  scene.friction_impulse.resize(surface.slaves(), Vector3d{});
  for (const auto* slaves : {&erosion.change.new_slave, &erosion.change.dead_slave})
    for (int slave : *slaves) {
      scene.normal_impulse[index(slave)] = {};
      scene.friction_impulse[index(slave)] = {};
    }
  change_features(scene, affected);
}

}  // namespace brio
