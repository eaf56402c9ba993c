#include "contact/scene.hpp"

#include "contact/ties/find_tied_pairs.hpp"

#include "contact/surface/exclusion.hpp"

namespace brio {

ContactScene::ContactScene() = default;
ContactScene::ContactScene(const ContactScene&) = default;
ContactScene::ContactScene(ContactScene&&) noexcept = default;
ContactScene& ContactScene::operator=(const ContactScene&) = default;
ContactScene& ContactScene::operator=(ContactScene&&) noexcept = default;
ContactScene::~ContactScene() = default;

ContactScene make_contact_scene(const ContactOptions& options, std::span<const SurfacePart> parts,
                                const Nodes& nodes) {
  ContactScene scene;
  scene.options = options;
  scene.surface = make_surface(parts, nodes.size());
  scene.excluded = excluded_faces(scene.surface, nodes);
  measure(scene.features, scene.surface, nodes);
  collect(scene.features, scene.surface, options);
  const std::size_t slaves = scene.surface.slaves();
  scene.velocity.resize(slaves, Vector3d{});
  scene.loaded.resize(slaves);
  scene.in_contact = scene.pushed = SlaveSet(slaves);
  scene.normal_impulse.resize(slaves, Vector3d{});
  scene.friction_impulse.resize(slaves, Vector3d{});
  return scene;
}

void exclude_tied_pairs(ContactScene& scene, const Ties& ties, const std::vector<int>& part_of_surface) {
  scene.surface.tied = find_tied_pairs(scene.surface, ties, part_of_surface);
}

void release_tied_pairs(ContactScene& scene, const Ties& ties) {
  renew(scene.surface.tied, scene.surface, ties);
  scene.pairs.expire();
}

}  // namespace brio
