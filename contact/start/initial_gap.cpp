#include "contact/start/initial_gap.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>

#include "contact/detection/crossing_guard.hpp"
#include "contact/enforcement/impulse_solver.hpp"
#include "contact/pairs/piercing.hpp"
#include "contact/start/enclosed.hpp"
#include "contact/start/overlap_report.hpp"
#include "contact/start/retraction.hpp"
#include "contact/start/sided_pairs.hpp"
#include "contact/surface/exclusion.hpp"
#include "contact/surface/face_geometry.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Overlaps are searched to a depth of this fraction of an edge, or to the limit.
constexpr double least_searched_share = 0.75;
/// Additional displacement, over the smallest edge, so that no error of the solver remains.
constexpr double surplus_share = 1e-8;
/// Of a unit vector.
constexpr double rounding_of_direction = 1e-9;
constexpr int most_rounds = 50;
/// If only the gap is missing, rounds continue as long as this many of them halve the missing gap.
constexpr int rounds_to_halve = 10;
constexpr SolveOptions solve_options{2000, 1e-7};
/// Search margins for the displacements of nodes (ContactOptions::reach_buffer): while overlaps are only
/// searched, those of retracted faces.
constexpr double buffer_of_retraction = 0.2;
/// Of a motion that would make surfaces cross: fraction of the time of the first hit.
constexpr double share_of_hit = 0.5;

/// Velocities of nodes serve as displacements; they are restored on destruction.
class Displacements {
 public:
  explicit Displacements(Nodes& nodes) : nodes_(nodes) {
    for (const NodeRecord& record : nodes.record)
      kept_.push_back({record.velocity[0], record.velocity[1], record.velocity[2]});
    clear();
  }
  ~Displacements() {
    for (std::size_t i = 0; i < kept_.size(); ++i)
      std::copy(kept_[i].begin(), kept_[i].end(), nodes_.record[i].velocity);
  }
  Displacements(const Displacements&) = delete;
  Displacements& operator=(const Displacements&) = delete;

  void clear() {
    for (NodeRecord& record : nodes_.record) std::fill(record.velocity, record.velocity + 3, 0.0);
  }
  void apply(double share) {
    for (NodeRecord& record : nodes_.record)
      for (int axis = 0; axis < 3; ++axis) record.position[axis] += share * record.velocity[axis];
  }

 private:
  Nodes& nodes_;
  std::vector<Vector3d> kept_;
};

class GapMaker {
 public:
  GapMaker(ContactScene& scene, Nodes& nodes, ThreadTeam& team)
      : scene_(scene),
        features_(scene.features),
        surface_(scene.surface),
        nodes_(nodes),
        team_(team),
        displacements_(nodes),
        report_(scene.features, scene.surface),
        block_(scene.surface.slaves(), -1) {}

  std::vector<InitialOverlap> run() {
    for (int node : surface_.node) start_.push_back(position(nodes_, node));
    expect_none_enclosed(scene_, nodes_, scene_.options.initial_overlap_limit);
    set_depths();
    search();
    expect_uncrossed(true);
    retract();
    const bool crosses = any_crosses();
    if (crosses) search_for_moves();
    find(0);
    while (exclude_within_pieces()) {
      crosses ? search_for_moves() : search();
      find(0);
    }
    expect_within_limit();
    for (const SidedPair& pair : found_)
      if (is_missing(pair) && (!is_fixed(pair) || must_move(pair))) report_.add(pair);
    const bool moves = !report_.empty() && make_gap();
    report_.add_motion(nodes_, start_);
    if (crosses || moves) expect_uncrossed(false);
    expect_bodies_apart(scene_, nodes_, 0);
    scene_.pairs.take_rest_of(pairs_);
    return report_.take();
  }

 private:
  bool is_missing(const SidedPair& pair) const { return pair.contact.gap < -resolved_share * pair.scale; }
  // Whether it is more than a gap that is missing.
  bool must_move(const SidedPair& pair) const {
    return !pair.is_apart || overlap(pair) > resolved_share * pair.scale;
  }
  const std::string& part_name(int part) const { return surface_.part_name[index(part)]; }

  // Of each node, by the shortest edge of the faces at it: a thin body is not looked through.
  void set_depths() {
    node_depth_.assign(surface_.slaves(), infinity);
    for (const Face& face : surface_.face) {
      if (!face.alive()) continue;
      const double edge = shortest_edge(nodes_, face);
      for (int corner : face.node) {
        double& depth = node_depth_[index(surface_.slave(corner))];
        depth = std::min(depth, edge);
      }
    }
    const double share = std::max(scene_.options.initial_overlap_limit, least_searched_share);
    for (double& depth : node_depth_) depth = share * (depth < infinity ? depth : features_.smallest_edge);
  }

  // Overlaps are searched in the mesh as given. An edge that passes through a flat face is not near a side of
  // it.
  void search() { search(buffer_of_retraction, {node_depth_}); }
  // Nodes are moved by the limit.
  void search_for_moves() {
    const ContactOptions& options = scene_.options;
    search(std::max(options.reach_buffer, 2 * options.initial_overlap_limit), {node_depth_, true});
  }
  void search(double reach_buffer, const SearchedDepth& depth) {
    displacements_.clear();
    motion_.forget();
    motion_.predict(features_, surface_, nodes_, 1, {}, team_);
    ContactOptions grown = scene_.options;
    grown.reach_buffer = reach_buffer;
    pairs_.expire();
    pairs_.find(features_, surface_, scene_.excluded, grown, motion_, team_, depth);
  }
  void find(double band) {
    find_sided_pairs(features_, surface_, nodes_, pairs_, {node_depth_}, band, found_);
  }

  // Pairs of one piece that overlap from the start are how the part was drawn: corners, seams, flanges; so
  // are those beside a tie.
  bool exclude_within_pieces() {
    std::vector<std::pair<int, int>> drawn;
    for (const SidedPair& pair : found_) {
      if (!pair.spaced || !is_missing(pair) || pair.skin >= 2 * features_.skin) continue;
      if (pair.contact.face >= 0) {
        const int body = surface_.body[index(pair.contact.slave)];
        if (surface_.tied.one_piece(pair.contact.body, body))
          drawn.emplace_back(pair.contact.slave, pair.contact.face);
        continue;
      }
      const EdgeFeature& a = features_.edge[index(pair.feature[0])];
      const EdgeFeature& b = features_.edge[index(pair.feature[1])];
      if (!surface_.tied.one_piece(a.body, b.body)) continue;
      for (const auto& [edge, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (int node : edge->node)
          for (int f : other->face)
            if (f >= 0) drawn.emplace_back(node, f);
    }
    std::erase_if(drawn,
                  [&](const auto& pair) { return is_excluded(scene_.excluded, pair.first, pair.second); });
    if (drawn.empty()) return false;
    exclude(drawn);
    return true;
  }

  void exclude(std::vector<std::pair<int, int>>& drawn) {
    std::sort(drawn.begin(), drawn.end());
    drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
    auto next = drawn.begin();
    Lists grown;
    grown.first.push_back(0);
    for (int s = 0; s < static_cast<int>(surface_.slaves()); ++s) {
      const auto known = scene_.excluded.of(s);
      const std::ptrdiff_t begin = std::ssize(grown.item);
      grown.item.insert(grown.item.end(), known.begin(), known.end());
      for (; next != drawn.end() && next->first == s; ++next) grown.item.push_back(next->second);
      std::sort(grown.item.begin() + begin, grown.item.end());
      grown.first.push_back(static_cast<int>(grown.item.size()));
    }
    scene_.excluded = std::move(grown);
    if (scene_.erosion) scene_.erosion->keeps_numbers = true;
  }

  void expect_within_limit() const {
    const SidedPair* deepest = nullptr;
    for (const SidedPair& pair : found_)
      if (is_zero(pair.contact.normal))
        refuse(pair, "at the same place, so that no direction separates them");
    for (const SidedPair& pair : found_)
      if (overlap(pair) > scene_.options.initial_overlap_limit * pair.scale &&
          (deepest == nullptr || overlap(pair) > overlap(*deepest)))
        deepest = &pair;
    if (deepest != nullptr) refuse(*deepest, "deeper than initial_overlap_limit allows");
  }

  [[noreturn]] void refuse(const SidedPair& pair, const char* why) const {
    const Vector3d x = position(nodes_, surface_.node[index(pair.contact.node[0])]);
    std::ostringstream text;
    text << "contact: part '" << part_name(pair.part[0]) << "' overlaps part '" << part_name(pair.part[1])
         << "' by " << std::max(overlap(pair), 0.0) << " at (" << x[0] << ", " << x[1] << ", " << x[2]
         << "), " << why;
    throw std::invalid_argument(text.str());
  }

  void retract() {
    const std::vector<TouchingPair> touching = retract_touching_faces(features_, surface_, pairs_, nodes_);
    for (const TouchingPair& pair : touching) report_.add(pair);
    if (!touching.empty() && has_left_boxes()) search();
  }

  // Whether a retracted face may have come near what it is not paired with.
  bool has_left_boxes() {
    motion_.predict(features_, surface_, nodes_, 1, {}, team_);
    return pairs_.is_due(features_, surface_, motion_, team_);
  }

  // Projection on the directions in which a node may be moved.
  SymmetricTensor<double> free_directions(int slave) const {
    const int node = surface_.node[index(slave)];
    const auto n = index(node);
    const bool tied = !surface_.tied.empty() && surface_.tied.main_part[n] >= 0;
    if (tied || surface_.rigid_body(node) >= 0) return isotropic(0.0);
    return nodes_.free_translations(n);
  }
  // Whether no node of either side can move along the normal.
  bool is_fixed(const SidedPair& pair) const {
    const Contact& contact = pair.contact;
    const Vector3d& normal = contact.normal;
    for (std::size_t k = 0; k < contact.node.size(); ++k) {
      if (contact.weight[k] == 0) continue;
      const Vector3d way = free_directions(contact.node[k]) * normal;
      if (dot(way, way) > rounding_of_direction * rounding_of_direction) return false;
    }
    return true;
  }

  const SidedPair* worst_missing() const {
    const SidedPair* worst = nullptr;
    for (const SidedPair& pair : found_) {
      if (!is_missing(pair) || (is_fixed(pair) && !must_move(pair))) continue;
      const auto badness = [&](const SidedPair& one) { return std::pair(must_move(one), -one.contact.gap); };
      if (worst == nullptr || badness(pair) > badness(*worst)) worst = &pair;
    }
    return worst;
  }

  // \returns whether nodes were moved
  bool make_gap() {
    double missing = 0, missing_before = infinity;
    for (int round = 0;; ++round) {
      const SidedPair* worst = worst_missing();
      if (worst == nullptr) return round > 0;
      const bool only_gap = !must_move(*worst);
      missing = -worst->contact.gap;
      const bool is_last = round >= most_rounds || is_fixed(*worst);
      if (!only_gap)  // before many rounds in vain
        expect_bodies_apart(scene_, nodes_, round > 0 || is_last ? 0 : scene_.options.initial_overlap_limit);
      if (!only_gap && is_last) refuse(*worst, "which moving nodes does not remove");
      if (round % rounds_to_halve == 0) {
        if (round >= most_rounds || (only_gap && missing > 0.5 * missing_before)) return true;
        missing_before = missing;
      }
      if (round == 0) search_for_moves();
      find(deepest() + 2 * features_.skin);
      move_apart();
      search_for_moves();
      find(0);
    }
  }

  double deepest() const {
    double depth = 0;
    for (const SidedPair& pair : found_) depth = std::max(depth, -pair.contact.gap);
    return depth;
  }

  void move_apart() {
    rows_.clear();
    blocks_.clear();
    std::vector<int> members;
    const auto block_of = [&](int slave) {
      int& block = block_[index(slave)];
      if (block >= 0) return block;
      block = static_cast<int>(blocks_.size());
      members.push_back(slave);
      blocks_.push_back({{0, 0, 0}, free_directions(slave)});
      return block;
    };
    for (const SidedPair& pair : found_) {
      if (is_fixed(pair)) continue;
      const Contact& contact = pair.contact;
      ConstraintRow& row =
          rows_.add_row({contact.normal[0], contact.normal[1], contact.normal[2]}, contact.gap, 0);
      row.target_velocity = surplus_share * features_.smallest_edge - contact.gap;
      for (std::size_t k = 0; k < contact.node.size(); ++k)
        if (contact.weight[k] != 0)
          rows_.add_point(block_of(contact.node[k]),
                          static_cast<int>(k) < contact.own ? Side::first : Side::second,
                          std::abs(contact.weight[k]));
    }
    solver_.solve(solve_options, rows_, blocks_, team_);
    for (std::size_t b = 0; b < members.size(); ++b) {
      const auto s = index(members[b]);
      block_[s] = -1;
      const Vector3d& moved = blocks_[b].velocity;
      double* v = nodes_.record[index(surface_.node[s])].velocity;
      v[0] = moved.x;
      v[1] = moved.y;
      v[2] = moved.z;
    }
    displacements_.apply(share_without_crossing());
  }

  // Bodies that overlap or touch have to leave each other; all others must not meet on the way.
  double share_without_crossing() {
    std::set<std::pair<int, int>> overlapping;
    for (const SidedPair& pair : found_)
      if (!pair.is_apart) overlapping.insert(std::minmax(first_body(pair.contact), pair.contact.body));
    motion_.predict(features_, surface_, nodes_, 1, {}, team_);
    Proximity all;
    all.node_face.resize(pairs_.node_face.size());
    all.edge_edge.resize(pairs_.edge_edge.size());
    std::iota(all.node_face.begin(), all.node_face.end(), 0);
    std::iota(all.edge_edge.begin(), all.edge_edge.end(), 0);
    CrossingGuard guard;
    find_hits(guard, all, features_, surface_, scene_.options, pairs_, motion_, {}, team_);
    double share = 1;
    for (const Hit& hit : guard.hits) {
      const auto p = hit.pair;
      const bool edges = hit.kind == PairKind::edge_edge;
      const int first = edges ? features_.edge[index(pairs_.edge_edge.first(p))].body
                              : surface_.body[index(pairs_.node_face.first(p))];
      const int second = edges ? features_.edge[index(pairs_.edge_edge.second(p))].body
                               : surface_.face[index(pairs_.node_face.second(p))].body;
      if (hit.time > 0 && !overlapping.contains(std::minmax(first, second)))
        share = std::min(share, share_of_hit * hit.time);
    }
    return share;
  }

  int first_body(const Contact& contact) const { return surface_.body[index(contact.node[0])]; }

  bool any_crosses() const {
    return find_piercing(features_, surface_, scene_.excluded, scene_.options, nodes_, false, team_)
        .has_value();
  }
  void expect_uncrossed(bool shells_alone) const {
    expect_nothing_crosses(features_, surface_, scene_.excluded, scene_.options, nodes_, shells_alone, team_);
  }

  ContactScene& scene_;
  SurfaceFeatures& features_;
  const Surface& surface_;
  Nodes& nodes_;
  ThreadTeam& team_;
  FeatureMotion motion_;
  FeaturePairs pairs_;
  Displacements displacements_;
  std::vector<double> node_depth_;  ///< to which overlaps are looked for
  std::vector<Vector3d> start_;     ///< of each slave node
  std::vector<SidedPair> found_;
  OverlapReport report_;
  ConstraintRows rows_;
  std::vector<VelocityBlock> blocks_;
  std::vector<int> block_;  ///< of each slave node, while rows are formed
  ImpulseSolver solver_;
};

}  // namespace

std::vector<InitialOverlap> make_initial_gap(ContactScene& scene, Nodes& nodes, ThreadTeam& team) {
  if (scene.surface.node.empty()) return {};
  return GapMaker(scene, nodes, team).run();
}

}  // namespace brio
