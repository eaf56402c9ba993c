#include "contact/features/flatness.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "contact/features/flat_hull.hpp"
#include "contact/features/flat_kinds.hpp"
#include "contact/features/gather.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Of the thickness up to which a shape stays flat, so that it does not change at every search.
constexpr double share_to_become_flat = 0.5;
constexpr std::size_t shapes_a_range = 256;

/// At most eight shapes at both ends of the step.
struct PackOfHulls {
  FlatHull<Pack> start, end;
};

// The last of them in the lanes that are left over.
template <class Kind>
PackOfHulls hulls_of(const Kind& kind, const int* shapes, std::size_t count) {
  constexpr std::size_t corners = std::tuple_size_v<std::remove_cvref_t<decltype(kind.nodes(0))>>;
  alignas(32) int node[corners][pack_size];
  for (std::size_t lane = 0; lane < pack_size; ++lane) {
    const auto& own = kind.nodes(index(shapes[std::min(lane, count - 1)]));
    for (std::size_t k = 0; k < corners; ++k) node[k][lane] = own[k];
  }
  constexpr std::size_t stride = sizeof(NodeMotion64) / sizeof(double);
  const auto hull_at = [&](const double* rows) {
    std::array<Vector3<Pack>, corners> at;
    for (std::size_t k = 0; k < corners; ++k) at[k] = gather_points<Pack>(rows, stride, node[k]);
    return flat_hull(at);
  };
  return {hull_at(kind.motion.node.data()->start), hull_at(kind.motion.node.data()->end)};
}

template <class Kind>
double thickness_of(const Kind& kind, const FlatShapes& shapes, std::size_t i) {
  return flat_thickness(kind.features, kind.radius(i), shapes.flat[i]);
}

/// \param visit (shape, hull at the start, at the end) of those in a list
template <class Kind, class Visit>
void for_hulls(const Kind& kind, std::span<const int> list, const Visit& visit) {
  for (std::size_t begin = 0; begin < list.size(); begin += pack_size) {
    const std::size_t count = std::min<std::size_t>(pack_size, list.size() - begin);
    const PackOfHulls hulls = hulls_of(kind, &list[begin], count);
    const auto in_lane = [](const FlatHull<Pack>& of, std::size_t k) {
      const int lane = static_cast<int>(k);
      return FlatHull<double>{of.thickness[lane], of.unfolded[lane], of.share[lane]};
    };
    for (std::size_t k = 0; k < count; ++k)
      visit(index(list[begin + k]), in_lane(hulls.start, k), in_lane(hulls.end, k));
  }
}

// Whether its path may be longer at the end of this step: as predicted, or as contact has moved a corner.
template <class Kind>
bool may_reach(const Kind& kind, std::size_t i, double path) {
  return kind.ahead(i) > path ||
         (kind.motion.is_solution() && kind.step_of_solution(i) > path - kind.path(i));
}

template <class Kind>
bool may_bend(const Kind& kind, const FlatShapes& shapes, std::size_t i) {
  return shapes.flat[i] != Flatness::none && may_reach(kind, i, shapes.until[i]);
}

// Take over the shape at the start of the step. \returns whether it may bend in the step
template <class Kind>
bool renew(const Kind& kind, FlatShapes& shapes, std::size_t i, const FlatHull<double>& start) {
  shapes.until[i] = kind.path(i) + start.slack(thickness_of(kind, shapes, i)) / kind.path_of_corners(i);
  return may_reach(kind, i, shapes.until[i]);
}

template <class Kind>
Flatness flatness_of(const Kind& kind, std::size_t i, const FlatHull<double>& start,
                     const FlatHull<double>& end) {
  for (const Flatness flatness : {Flatness::all, Flatness::radii}) {
    const double thickness = share_to_become_flat * flat_thickness(kind.features, kind.radius(i), flatness);
    if (start.slack(thickness) > 0 && end.slack(thickness) > 0) return flatness;
  }
  return Flatness::none;
}

/// \param visit (shape, hull at the start, at the end) of listed shapes that may bend in this step, by
/// ranges. Those for which it is true are at risk.
template <class Kind, class Visit>
void for_bending(const Kind& kind, FlatShapes& shapes, ThreadTeam& team, const Visit& visit) {
  shapes.make_room();  // a restored run has none yet
  shapes.seen = shapes.list.size();
  shapes.risks.resize((shapes.seen + shapes_a_range - 1) / shapes_a_range);
  team.for_ranges(shapes.seen, shapes_a_range, [&](std::size_t begin, std::size_t end) {
    int* const first = &shapes.at_risk[begin];
    int* last = first;
    for (std::size_t k = begin; k < end; ++k)
      if (may_bend(kind, shapes, index(shapes.list[k]))) *last++ = shapes.list[k];
    const std::span<const int> bending(first, last);
    last = first;
    for_hulls(kind, bending,
              [&](std::size_t i, const FlatHull<double>& start, const FlatHull<double>& end_hull) {
                if (visit(i, start, end_hull)) *last++ = static_cast<int>(i);
              });
    shapes.risks[begin / shapes_a_range] = index(last - first);
  });
}

template <class Kind>
bool any_bends_of(const Kind& kind, FlatShapes& shapes, ThreadTeam& team) {
  std::atomic<bool> any = false;
  for_bending(kind, shapes, team,
              [&](std::size_t i, const FlatHull<double>& start, const FlatHull<double>& end) {
                if (!renew(kind, shapes, i, start)) return false;
                if (!(end.slack(thickness_of(kind, shapes, i)) >= 0))
                  any.store(true, std::memory_order_relaxed);
                return true;
              });
  return any;
}

/// \param visit shapes that are less flat than they were
template <class Kind, class Visit>
void take_over_bent(const Kind& kind, FlatShapes& shapes, ThreadTeam& team, const Visit& visit) {
  for_bending(kind, shapes, team,
              [&](std::size_t i, const FlatHull<double>& start, const FlatHull<double>& end) {
                if (!renew(kind, shapes, i, start)) return false;
                const Flatness now = flatness_of(kind, i, start, end);
                if (now > std::exchange(shapes.flat[i], std::max(now, shapes.flat[i]))) visit(i);
                return shapes.flat[i] != Flatness::none;
              });
  shapes.close_up();
}

template <class Kind>
bool any_ends_bent(const Kind& kind, const FlatShapes& shapes, std::span<const int> list) {
  bool bent = false;
  for_hulls(kind, list, [&](std::size_t i, const FlatHull<double>&, const FlatHull<double>& end) {
    bent |= !(end.slack(thickness_of(kind, shapes, i)) >= 0);
  });
  return bent;
}

// Of those at risk as predicted, and of those that are watched since.
template <class Kind>
bool any_at_risk_bends(const Kind& kind, const FlatShapes& shapes, ThreadTeam& team) {
  std::atomic<bool> any = any_ends_bent(kind, shapes, std::span(shapes.list).subspan(shapes.seen));
  team.for_each(shapes.risks.size(), [&](std::size_t range) {
    if (any_ends_bent(kind, shapes,
                      std::span(shapes.at_risk).subspan(range * shapes_a_range, shapes.risks[range])))
      any.store(true, std::memory_order_relaxed);
  });
  return any;
}

template <class Kind>
void begin_to_watch(const Kind& kind, FlatShapes& shapes, int i) {
  const auto one = index(i);
  if (!kind.exists(one) || shapes.flat[one] != Flatness::none) return;
  for_hulls(kind, std::array{i},
            [&](std::size_t, const FlatHull<double>& start, const FlatHull<double>& end) {
              shapes.flat[one] = flatness_of(kind, one, start, end);
              if (shapes.flat[one] == Flatness::none) return;
              shapes.list.push_back(i);
              renew(kind, shapes, one, start);
            });
}

std::array<int, 6> nodes_of_side(const SurfaceFeatures& features, const EdgeFeature& edge) {
  std::array<int, 6> node{edge.node[0], edge.node[1]};
  for (std::size_t k = 0; k < 2; ++k) {
    std::size_t next = 2 + 2 * k;
    for (int corner : features.face_node[index(edge.face[k])])
      if (corner != edge.node[0] && corner != edge.node[1] && next < 4 + 2 * k) node[next++] = corner;
    if (next == 3 + 2 * k) node[next] = node[next - 1];
  }
  return node;
}

}  // namespace

double flat_thickness(const SurfaceFeatures& features, double radius, Flatness flatness) {
  const double for_all = flat_share_of_skin * features.skin;
  return flatness == Flatness::all ? for_all : std::max(for_all, flat_share_of_radius * radius);
}

void FlatShapes::forget(std::size_t count) {
  flat.assign(count, Flatness::none);
  until.assign(count, 0);
  list.clear();
  make_room();
}

void FlatShapes::make_room() {
  list.reserve(flat.size());
  at_risk.resize(flat.size());
  risks.reserve(flat.size() / shapes_a_range + 1);
  risks.clear();
  seen = 0;
}

void FlatShapes::change(std::size_t count, std::span<const int> changed) {
  flat.resize(count, Flatness::none);
  until.resize(count, 0);
  for (int i : changed) flat[index(i)] = Flatness::none;
  close_up();
  make_room();
}

void FlatShapes::close_up() {
  std::erase_if(list, [&](int i) { return flat[index(i)] == Flatness::none; });
  seen = list.size();
}

void SurfaceFlatness::forget(const SurfaceFeatures& features, bool finds_flat) {
  faces_.forget(features.face_node.size());
  sides_.forget(features.edge.size());
  is_watched_.assign(features.face_node.size(), 0);
  finds_flat_ = finds_flat;
  side_node_.assign(features.edge.size(), {});
}

void SurfaceFlatness::change(const SurfaceFeatures& features, const FeatureMotion& motion,
                             std::span<const int> faces, std::span<const int> edges) {
  lengths_.change(features, motion, edges);
  faces_.change(features.face_node.size(), faces);
  sides_.change(features.edge.size(), edges);
  is_watched_.resize(features.face_node.size(), 0);
  side_node_.resize(features.edge.size());
  for (int f : faces) is_watched_[index(f)] = 0;
  for (int e : edges)
    for (int f : features.edge[index(e)].face)
      if (f >= 0) is_watched_[index(f)] = 0;
}

void SurfaceFlatness::hold(std::span<const Contact> constraints) {
  held_.clear();
  for (const Contact& contact : constraints)
    if (contact.of_edges()) {
      const std::array<int, 5>& node = contact.node;
      held_.push_back({node[0], node[1]});
      held_.push_back({node[2], node[3]});
    }
  std::sort(held_.begin(), held_.end());
}

bool SurfaceFlatness::is_held(const EdgeFeature& edge) const {
  return std::binary_search(held_.begin(), held_.end(), edge.node);
}

void SurfaceFlatness::watch(const SurfaceFeatures& features, const FeatureMotion& motion, int face) {
  if (!finds_flat_ || is_watched_[index(face)] != 0) return;
  is_watched_[index(face)] = 1;
  const FlatFaces faces{features, motion};
  const FlatSides sides{faces, side_node_};
  const auto& [first, second] = features.diagonal_of_face[index(face)];
  if (first >= 0 && !is_held(features.edge[index(first)]) && !is_held(features.edge[index(second)]))
    begin_to_watch(faces, faces_, face);
  for (int e : features.edge_of_face[index(face)]) {
    if (e < 0 || !sides.exists(index(e))) continue;
    side_node_[index(e)] = nodes_of_side(features, features.edge[index(e)]);
    if (!is_held(features.edge[index(e)])) begin_to_watch(sides, sides_, e);
  }
}

bool SurfaceFlatness::any_bends(const SurfaceFeatures& features, const FeatureMotion& motion,
                                ThreadTeam& team) {
  const FlatFaces faces{features, motion};
  return any_bends_of(faces, faces_, team) || any_bends_of(FlatSides{faces, side_node_}, sides_, team);
}

// Those at risk as predicted, and those with a corner that has moved farther than predicted: a face at the
// first of these corners, a side with the first of its faces that has one.
bool SurfaceFlatness::any_bends_by_solution(const SurfaceFeatures& features, const Surface& surface,
                                            const FeatureMotion& motion, ThreadTeam& team) {
  const FlatFaces faces{features, motion};
  const FlatSides sides{faces, side_node_};
  if (any_at_risk_bends(faces, faces_, team) || any_at_risk_bends(sides, sides_, team)) return true;
  std::atomic<bool> any = false;
  motion.for_each_corrected(team, [&](std::size_t, std::size_t s) {
    const int slave = static_cast<int>(s);
    if (surface.node[s] < 0 || !motion.exceeds_prediction(slave)) return;
    bool bent = false;
    for (int f : surface.faces_of.of(slave)) {
      if (faces.exceeds_prediction(index(f), slave)) continue;
      if (may_bend(faces, faces_, index(f))) bent |= any_ends_bent(faces, faces_, std::array{f});
      std::array<int, 4> moved;
      std::size_t count = 0;
      for (int e : features.edge_of_face[index(f)]) {
        if (e < 0 || !may_bend(sides, sides_, index(e))) continue;
        const int first = features.edge[index(e)].face[0];
        if (first == f || !faces.exceeds_prediction(index(first))) moved[count++] = e;
      }
      bent |= any_ends_bent(sides, sides_, std::span(moved).first(count));
    }
    if (bent) any.store(true, std::memory_order_relaxed);
  });
  return any;
}

void SurfaceFlatness::take_over(const SurfaceFeatures& features, const FeatureMotion& motion,
                                std::uint8_t mark, std::vector<std::uint8_t>& flags, ThreadTeam& team) {
  const FlatFaces faces{features, motion};
  const auto flag = [&](int face) { std::atomic_ref(flags[index(face)]).fetch_or(mark); };
  take_over_bent(faces, faces_, team, [&](std::size_t f) { flag(static_cast<int>(f)); });
  take_over_bent(FlatSides{faces, side_node_}, sides_, team, [&](std::size_t e) {
    for (int face : features.edge[e].face) flag(face);
  });
  for (int e : lengths_.strained())
    for (int face : features.edge[index(e)].face)
      if (face >= 0) flag(face);
}

}  // namespace brio
