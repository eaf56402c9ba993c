#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "src/build/build.hpp"
#include "src/deck/part_index.hpp"

namespace brio {

namespace {

bool inside(const std::monostate&, const Vector3d&) { return true; }
bool inside(const BoxRegion& box, const Vector3d& x) {
  for (std::size_t i = 0; i < 3; ++i)
    if (x[i] < box.lower[i] || x[i] > box.upper[i]) return false;
  return true;
}
bool inside(const PlaneRegion& plane, const Vector3d& x) {
  return std::abs(dot(plane.normal, x - plane.point)) <= plane.tolerance * norm(plane.normal);
}
bool inside(const SphereRegion& sphere, const Vector3d& x) {
  return squared_norm(x - sphere.centre) <= sphere.radius * sphere.radius;
}

// The part of that name, or those of the mesh file of that name.
std::vector<std::size_t> parts_called(const std::string& name, const Deck& deck, const Model& model,
                                      const std::string& place) {
  if (const auto part = model.part_number.find(name); part != model.part_number.end()) return {part->second};
  std::vector<std::size_t> found = parts_called(name, deck);
  if (found.empty()) throw no_part(name, place);
  return found;
}

}  // namespace

std::vector<int> select_nodes(const NodeSelection& where, const Deck& deck, std::span<const Mesh> meshes,
                              const Model& model) {
  std::vector<int> chosen;
  if (!where.set.empty()) {
    const std::size_t dot_at = where.set.find('.');
    const std::string name = where.set.substr(0, dot_at);
    const std::string set = dot_at == std::string::npos ? "all" : where.set.substr(dot_at + 1);
    bool is_there = false;
    for (const std::size_t p : parts_called(name, deck, model, where.place)) {
      const std::vector<int>& node = model.parts[p].node;
      const auto found = meshes[p].node_sets.find(set);
      is_there = is_there || set == "all" || found != meshes[p].node_sets.end();
      if (set == "all")
        chosen.insert(chosen.end(), node.begin(), node.end());
      else if (found != meshes[p].node_sets.end())
        for (const int of_mesh : found->second) chosen.push_back(node[index(of_mesh)]);
    }
    if (!is_there) throw BuildError("part '" + name + "' has no set '" + set + "'", where.place);
  } else {
    for (std::size_t p = 0; p < deck.parts.size(); ++p) {
      if (!where.part.empty() && deck.parts[p].name != where.part) continue;
      for (int node : model.parts[p].node) {
        const double* x = model.nodes.record[index(node)].position;
        if (std::visit([&](const auto& region) { return inside(region, vector_at(x)); }, where.region))
          chosen.push_back(node);
      }
    }
  }
  if (chosen.empty()) throw BuildError("a condition or load selects no node", where.place);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());  // parts can share nodes
  return chosen;
}

}  // namespace brio
