#include "contact/pairs/laid_open.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "contact/pairs/piercing.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"
#include "src/base/lists.hpp"

namespace brio {

namespace {

/// Sides and diagonals of a face, by corner.
constexpr std::array<std::array<std::size_t, 2>, 6> segments{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 2}, {1, 3}}};

CaptureBox bounds_of(const FaceVertices& at) {
  CaptureBox bounds = empty_box;
  for (const Vector3d& x : at) bounds.include(x);
  return bounds;
}

class LaidOpen {
 public:
  LaidOpen(const Surface& surface, const Nodes& nodes, std::span<const int> laid_open)
      : surface_(surface), nodes_(nodes) {
    for (int f : laid_open)
      if (is_side(f)) open_.push_back(f);
  }

  // The other faces by the boxes of the last search, those exposed since then by their own.
  void find_near(FeaturePairs& pairs, const FeatureMotion& motion, ThreadTeam& team) {
    const std::span<const int> since = pairs.faces_since_search();
    std::vector<int> young(since.begin(), since.end());
    young.insert(young.end(), open_.begin(), open_.end());
    std::erase_if(young, [&](int f) { return !is_side(f); });
    sort_out(young);
    const std::vector<CaptureBox> boxes = boxes_of(open_), boxes_of_young = boxes_of(young);
    TreeSearch search;
    CandidatePairs found;
    SearchCounts counts;
    search.find(SearchNodes(boxes_of_young), boxes, team, found, counts);
    for (std::size_t i = 0; i < open_.size(); ++i)
      for (int other : found.of_box(i)) near_.emplace_back(open_[i], young[index(other)]);
    for (const auto& [i, g] : pairs.find_faces(boxes, motion, team)) near_.emplace_back(open_[i], g);
  }

  std::vector<SurfaceElement> crossed() const {
    std::vector<std::pair<int, int>> elements;
    for (const auto& [f, g] : near_)
      if (is_side(g) && f != g && (pierces(f, g) || pierces(g, f)))
        elements.emplace_back(face(f).part, face(f).element);
    sort_out(elements);
    std::vector<SurfaceElement> found;
    for (const auto& [part, element] : elements) found.push_back({part, element});
    return found;
  }

 private:
  const Face& face(int f) const { return surface_.face[index(f)]; }
  bool is_side(int f) const { return face(f).alive() && !face(f).shell; }
  std::vector<CaptureBox> boxes_of(const std::vector<int>& faces) const {
    std::vector<CaptureBox> boxes;
    for (int f : faces) boxes.push_back(bounds_of(vertices(nodes_, face(f))));
    return boxes;
  }

  // Whether a segment of the first face passes through the second.
  bool pierces(int f, int g) const {
    const Face &own = face(f), &other = face(g);
    const FaceVertices from = vertices(nodes_, own), at = vertices(nodes_, other);
    if (!bounds_of(from).overlaps(bounds_of(at))) return false;
    return std::any_of(segments.begin(), segments.end(), [&](const auto& ends) {
      if (own.node[ends[0]] == own.node[ends[1]]) return false;
      if (other.has(own.node[ends[0]]) || other.has(own.node[ends[1]])) return false;
      return passes_through(from[ends[0]], from[ends[1]], at, false);
    });
  }

  const Surface& surface_;
  const Nodes& nodes_;
  std::vector<int> open_;
  std::vector<std::pair<int, int>> near_;
};

}  // namespace

std::vector<SurfaceElement> find_crossed_elements(const Surface& surface, FeaturePairs& pairs,
                                                  const FeatureMotion& motion, const Nodes& nodes,
                                                  std::span<const int> laid_open, ThreadTeam& team) {
  LaidOpen look(surface, nodes, laid_open);
  look.find_near(pairs, motion, team);
  return look.crossed();
}

}  // namespace brio
