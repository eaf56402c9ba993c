#include <tuple>

#include "contact/geometry/closest_segments.hpp"
#include "contact/start/sided_look.hpp"
#include "contact/start/sided_pairs.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Edges that are more parallel meet with their ends.
constexpr double crossing_sine = 0.05;

class SidedEdgePairs {
 public:
  SidedEdgePairs(const SidedLook& look, const FeaturePairs& pairs, double band, std::vector<SidedPair>& found)
      : look_(look),
        features_(look.features),
        surface_(look.surface),
        list_(pairs.edge_edge),
        band_(band),
        found_(found),
        coincident_(coincident_share * look.features.smallest_edge) {}

  void run() {
    for (std::size_t pair = 0; pair < list_.size(); ++pair) look_at(pair);
  }

 private:
  Segment segment(const EdgeFeature& edge) const { return {look_.at(edge.node[0]), look_.at(edge.node[1])}; }
  bool one_piece(const EdgeFeature& a, const EdgeFeature& b) const {
    return a.body == b.body || surface_.tied.one_piece(a.body, b.body);
  }
  static bool of_solid(const EdgeFeature& edge) { return edge.of_face() && !edge.shell; }
  bool is_spaced(std::size_t pair) const { return list_.has_radii(pair); }
  double reach_of(std::size_t pair) const {
    return is_spaced(pair) ? look_.edge(list_.first(pair)).radius + look_.edge(list_.second(pair)).radius
                           : 2 * features_.skin;
  }

  void look_at(std::size_t pair) {
    const int ea = list_.first(pair), eb = list_.second(pair);
    const EdgeFeature &a = look_.edge(ea), &b = look_.edge(eb);
    const Segment sa = segment(a), sb = segment(b);
    const bool solids = of_solid(a) && of_solid(b) && a.body != b.body;
    const double reach = reach_of(pair);
    const double limit =
        solids ? std::max(reach + band_, 0.5 * (look_.depth.of(a) + look_.depth.of(b))) : reach + band_;
    for (int axis = 0; axis < 3; ++axis)
      if (std::min(sa[0][axis], sa[1][axis]) > std::max(sb[0][axis], sb[1][axis]) + limit ||
          std::min(sb[0][axis], sb[1][axis]) > std::max(sa[0][axis], sa[1][axis]) + limit)
        return;
    const ClosestSegments closest = closest_points_of_segments(sa, sb);
    const double distance = std::sqrt(closest.squared_distance);
    if (distance > limit) return;
    const Feet feet{closest.parameters, sa[0] + closest.parameters[0] * (sa[1] - sa[0]),
                    sb[0] + closest.parameters[1] * (sb[1] - sb[0])};
    if (distance <= coincident_) {
      const Vector3d way = way_between(a, b, feet, closest.normal);
      if (!is_zero(way)) add(pair, feet, way, dot(way, closest.offset), false);
      if (is_zero(way) && !(a.of_face() && b.of_face()) && is_spaced(pair) && !one_piece(a, b))
        add_without_side(ea, eb, reach);
      return;
    }
    const Vector3d normal = closest.offset / distance;
    if (!solids || are_outside(a, b, normal)) {
      add(pair, feet, normal, distance, true);
    } else if (are_crossed(sa, sb) && is_behind(b, closest.offset) && is_behind(a, -closest.offset)) {
      add(pair, feet, -normal, -distance, false);
    }
  }

  struct Feet {
    std::array<double, 2> parameter;
    Vector3d on_a, on_b;
  };

  // Sum of the outward normals of the faces at an edge.
  Vector3d normal_of(const EdgeFeature& edge) const {
    Vector3d sum{};
    for (int f : edge.face) {
      if (f < 0) continue;
      const FaceVertices at = look_.corners(surface_.face[index(f)]);
      sum += normalized(cross(at[2] - at[0], at[3] - at[1]));
    }
    return sum;
  }
  // Whether a point, from one on the edge, lies behind both faces.
  bool is_behind(const EdgeFeature& edge, const Vector3d& offset) const {
    return std::all_of(edge.face.begin(), edge.face.end(), [&](int f) {
      if (f < 0) return true;
      const FaceVertices at = look_.corners(surface_.face[index(f)]);
      return dot(normalized(cross(at[2] - at[0], at[3] - at[1])), offset) < -coincident_;
    });
  }
  static bool are_crossed(const Segment& a, const Segment& b) {
    const Vector3d along_a = normalized(a[1] - a[0]), along_b = normalized(b[1] - b[0]);
    return norm(cross(along_a, along_b)) > crossing_sine;
  }
  bool are_outside(const EdgeFeature& a, const EdgeFeature& b, const Vector3d& from_b) const {
    return dot(from_b, normal_of(b)) >= 0 || dot(from_b, normal_of(a)) <= 0;
  }

  // Of edges that coincide: the mean of the directions along which both are apart, among the normals of
  // their faces and what is at right angles to both edges.
  Vector3d way_between(const EdgeFeature& a, const EdgeFeature& b, const Feet& feet,
                       const Vector3d& across) const {
    Directions ways;
    const auto consider = [&](const Vector3d& way) {
      if (stands_off(a, feet.on_a, way) && stands_off(b, feet.on_b, -way)) ways.add(way);
    };
    for (const auto& [edge, sign] : {std::pair(&a, -1.0), std::pair(&b, 1.0)})
      for (int f : edge->face) {
        if (f < 0) continue;
        const Face& face = surface_.face[index(f)];
        const FaceVertices at = look_.corners(face);
        const Vector3d normal = sign * normalized(cross(at[2] - at[0], at[3] - at[1]));
        consider(normal);
        if (face.shell) consider(-normal);
      }
    const Vector3d along = unit_or(across, Vector3d{});
    if (!is_zero(along) && is_zero(ways.mean())) {
      consider(along);
      if (is_zero(ways.mean())) consider(-along);
    }
    return ways.mean();
  }

  // Whether an edge and the faces beside it lie on the side of a plane through a point of the edge.
  bool stands_off(const EdgeFeature& edge, const Vector3d& foot, const Vector3d& way) const {
    const auto is_behind = [&](int slave) {
      if (slave < 0) return false;
      const Vector3d arm = look_.at(slave) - foot;
      return dot(arm, way) < -SidedLook::behind_sine * norm(arm);
    };
    return !is_behind(edge.node[0]) && !is_behind(edge.node[1]) &&
           std::none_of(edge.wing.begin(), edge.wing.end(), is_behind);
  }

  // Beams and particles in one place.
  void add_without_side(int ea, int eb, double reach) {
    const EdgeFeature &a = look_.edge(ea), &b = look_.edge(eb);
    SidedPair one;
    one.contact.node = {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
    one.contact.gap = -reach;
    one.contact.face = -1;
    one.contact.slave = first_edge_slave + ea;
    one.scale = reach;
    one.is_apart = false;
    one.feature = {ea, eb};
    one.part = {a.part, b.part};
    one.support = {ea, eb};
    found_.push_back(one);
  }

  void add(std::size_t pair, const Feet& feet, const Vector3d& normal, double distance, bool is_apart) {
    const double reach = reach_of(pair);
    if (distance - reach > band_) return;
    const int ea = list_.first(pair), eb = list_.second(pair);
    const EdgeFeature &a = look_.edge(ea), &b = look_.edge(eb);
    SidedPair one;
    if (!look_.is_minimum(ea, feet.parameter[0], feet.on_a, normal, one.support[0]) ||
        !look_.is_minimum(eb, feet.parameter[1], feet.on_b, -normal, one.support[1]))
      return;
    Contact& contact = one.contact;
    contact.slave = first_edge_slave + (one.support[0] >= 0 ? one.support[0] : ea);
    contact.face = -1;
    contact.body = b.body;
    contact.own = 2;
    contact.node = {a.node[0], a.node[1], b.node[0], b.node[1], b.node[1]};
    contact.weight = {1 - feet.parameter[0], feet.parameter[0], feet.parameter[1] - 1, -feet.parameter[1], 0};
    contact.normal = normal;
    contact.gap = distance - reach;
    one.distance = distance;
    one.skin = is_spaced(pair) ? look_.skin_in(a.radius) + look_.skin_in(b.radius) : 2 * features_.skin;
    one.scale = reach - one.skin > 0 ? reach - one.skin : features_.smallest_edge;
    one.is_apart = is_apart;
    one.spaced = is_spaced(pair);
    one.feature = {ea, eb};
    one.part = {a.part, b.part};
    found_.push_back(one);
  }

  const SidedLook& look_;
  const SurfaceFeatures& features_;
  const Surface& surface_;
  const PairList& list_;
  double band_;
  std::vector<SidedPair>& found_;
  double coincident_;
};

}  // namespace

void find_sided_edges(const SidedLook& look, const FeaturePairs& pairs, double band,
                      std::vector<SidedPair>& found) {
  SidedEdgePairs(look, pairs, band, found).run();
}

}  // namespace brio
