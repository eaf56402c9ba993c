#include "contact/detection/laid_open.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "contact/detection/piercing.hpp"
#include "contact/face_geometry.hpp"

namespace brio {

namespace {

/// Sides and diagonals of a face, by corner.
constexpr std::array<std::array<std::size_t, 2>, 6> segments{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}}};

class LaidOpen {
 public:
  LaidOpen(const Surface& surface, const SurfaceTopology& topology, const Nodes& nodes)
      : surface_(surface), topology_(topology), nodes_(nodes) {}

  bool crosses_another(int f) {
    near_.clear();
    add_faces_at(element_of(topology_, face(f)));
    sort_out(near_);
    const std::vector<int> first = near_;
    for (int g : first) add_faces_at(element_of(topology_, face(g)));
    sort_out(near_);
    return std::any_of(near_.begin(), near_.end(),
                       [&](int g) { return g != f && (pierces(f, g) || pierces(g, f)); });
  }

 private:
  const Face& face(int f) const { return surface_.face[static_cast<std::size_t>(f)]; }

  static std::pair<double, double> range(const FaceVertices& at, int axis) {
    return {std::min({at[0][axis], at[1][axis], at[2][axis], at[3][axis]}),
            std::max({at[0][axis], at[1][axis], at[2][axis], at[3][axis]})};
  }

  static void sort_out(std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }

  void add_faces_at(int element) {
    for (int node : nodes_of(topology_, element))
      if (const int slave = surface_.slave(node); slave >= 0)
        for (int f : surface_.faces_of.of(slave))
          if (face(f).alive() && !face(f).shell) near_.push_back(f);
  }

  // Whether a segment of the first face passes through the second.
  bool pierces(int f, int g) const {
    const Face &own = face(f), &other = face(g);
    const FaceVertices from = vertices(nodes_, own), at = vertices(nodes_, other);
    for (int axis = 0; axis < 3; ++axis) {
      const auto [least, most] = range(from, axis);
      const auto [lower, upper] = range(at, axis);
      if (least > upper || most < lower) return false;
    }
    return std::any_of(segments.begin(), segments.end(), [&](const auto& ends) {
      if (own.node[ends[0]] == own.node[ends[1]]) return false;
      if (other.has(own.node[ends[0]]) || other.has(own.node[ends[1]])) return false;
      return passes_through(from[ends[0]], from[ends[1]], at, false);
    });
  }

  const Surface& surface_;
  const SurfaceTopology& topology_;
  const Nodes& nodes_;
  std::vector<int> near_;
};

}  // namespace

std::vector<SurfaceElement> find_crossed_elements(const Surface& surface, const SurfaceTopology& topology,
                                                  const Nodes& nodes, std::span<const int> laid_open) {
  LaidOpen look(surface, topology, nodes);
  std::vector<std::pair<int, int>> crossed;
  for (int f : laid_open) {
    const Face& face = surface.face[static_cast<std::size_t>(f)];
    if (face.alive() && !face.shell && look.crosses_another(f)) crossed.emplace_back(face.part, face.element);
  }
  std::sort(crossed.begin(), crossed.end());
  crossed.erase(std::unique(crossed.begin(), crossed.end()), crossed.end());
  std::vector<SurfaceElement> elements;
  for (const auto& [part, element] : crossed) elements.push_back({part, element});
  return elements;
}

}  // namespace brio
