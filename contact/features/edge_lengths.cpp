#include "contact/features/edge_lengths.hpp"

#include <algorithm>
#include <limits>

namespace brio {

namespace {

struct Extent {
  float length = 0, width = 0;
};

Extent extent_of(const SurfaceFeatures& features, const FeatureMotion& motion, const EdgeFeature& edge) {
  if (!edge.of_face()) return {.length = std::numeric_limits<float>::infinity()};
  const double length = norm(motion.start(edge.node[1]) - motion.start(edge.node[0]));
  Extent extent{.length = static_cast<float>(length)};
  if (!edge.joins_faces()) return extent;
  double area = std::numeric_limits<double>::infinity();
  for (int face : edge.face) {
    const std::array<int, 4>& corner = features.face_node[index(face)];
    const Vector3d first = motion.start(corner[2]) - motion.start(corner[0]),
                   second = motion.start(corner[3]) - motion.start(corner[1]);
    area = std::min(area, 0.5 * norm(cross(first, second)));
  }
  if (length > 0) extent.width = static_cast<float>(area / length);
  return extent;
}

}  // namespace

void EdgeLengths::make_room(std::size_t edges) {
  length_.resize(edges);
  width_.resize(edges);
  strained_.reserve(edges);
  strained_of_range_.resize((edges + edges_a_range - 1) / edges_a_range);
  for (std::vector<int>& strained : strained_of_range_) strained.reserve(edges_a_range);
}

void EdgeLengths::measure(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team) {
  make_room(features.edge.size());
  team.for_ranges(features.edge.size(), edges_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const Extent extent = extent_of(features, motion, features.edge[e]);
      length_[e] = extent.length;
      width_[e] = extent.width;
    }
  });
}

void EdgeLengths::change(const SurfaceFeatures& features, const FeatureMotion& motion,
                         std::span<const int> edges) {
  make_room(features.edge.size());
  for (int e : edges) {
    const Extent extent = extent_of(features, motion, features.edge[index(e)]);
    length_[index(e)] = extent.length;
    width_[index(e)] = extent.width;
  }
}

bool EdgeLengths::follow(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team) {
  strained_.clear();
  if (!is_measured() || ++steps_ % steps_between != 0) return false;
  const std::size_t edges = std::min(length_.size(), features.edge.size());
  make_room(length_.size());  // a restored run has none yet
  const auto is_off = [](float now, float kept) {
    return now > most_change * kept || most_change * now < kept;
  };
  team.for_ranges(edges, edges_a_range, [&](std::size_t begin, std::size_t end) {
    std::vector<int>& strained = strained_of_range_[begin / edges_a_range];
    strained.clear();
    for (std::size_t e = begin; e < end; ++e) {
      if (!features.edge[e].of_face()) continue;
      const Extent now = extent_of(features, motion, features.edge[e]);
      if (!is_off(now.length, length_[e]) && !is_off(now.width, width_[e])) continue;
      if (now.length > length_[e] || now.width < width_[e]) strained.push_back(static_cast<int>(e));
      length_[e] = now.length;
      width_[e] = now.width;
    }
  });
  for (const std::vector<int>& strained : strained_of_range_)
    strained_.insert(strained_.end(), strained.begin(), strained.end());
  return !strained_.empty();
}

}  // namespace brio
