#include "contact/line_detect.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/closest_segments.hpp"
#include "contact/edge_check.hpp"
#include "contact/face_geometry.hpp"

namespace brio {

using Eigen::Vector3d;

namespace {

constexpr std::size_t lines_per_task = 64;
/// An edge lies in a face of the other within 0.8 degrees (the sine).
constexpr double flush = 0.014;
/// A contact of the last step is followed as far as this beyond the normals of the faces (6 degrees): faces
/// turn as they are pressed, and nothing may slip in while they do.
constexpr double followed = 0.1;
/// Edges flush with faces meet each other only so far from their ends, in lengths: nearer to them a node
/// meets the face, and what the end of an upright edge would catch on is a seam between faces.
constexpr double end_share = 0.02;
/// Where an edge goes on beyond its end, it is met so far beyond it: nothing slips through between the two.
constexpr double overlap_share = 0.01;
/// Edges of solids are parallel within 1 degree (the sine): the nodes of one then meet the faces of the
/// other.
constexpr double parallel = 0.0175;
/// Directions are formed from positions only where these are farther apart than this share of the length.
constexpr double direction_share = 1e-8;
/// Overlaps below this share of the length are rounding and impulses not yet converged, not penetration.
constexpr double touching_share = 1e-6;

/// The detailed check of one pair.
class LineCheck {
 public:
  LineCheck(LineCandidates& candidates, const Surface& surface, const ContactOptions& options,
            const Candidates& faces, const Nodes& nodes, const Travel& travel, std::span<const Contact> last,
            std::vector<Contact>& found)
      : candidates_(candidates),
        surface_(surface),
        options_(options),
        faces_(faces),
        nodes_(nodes),
        travel_(travel),
        last_(last),
        found_(found),
        frame_(travel.frame(0), travel.frame(1), travel.frame(2)) {}

  void run(int first) {
    number_ = first;
    const auto f = static_cast<std::size_t>(first);
    const auto begin = static_cast<std::size_t>(candidates_.partners.first[f]);
    const auto partners = candidates_.partners.of(first);
    if (partners.empty()) return;
    a_ = &candidates_.line[f];
    if (!is_alive(surface_, *a_)) return;
    find_history();
    for (std::size_t k = 0; k < partners.size(); ++k) {
      const auto second = static_cast<std::size_t>(partners[k]);
      const double so_far = travel_.so_far_of(candidates_.path[f], candidates_.path[second]);
      const double ahead = travel_.ahead_of(candidates_.ahead[f], candidates_.ahead[second]);
      double& wake = candidates_.wake[begin + k];
      if (so_far + ahead < wake) continue;
      b_ = &candidates_.line[second];
      if (is_alive(surface_, *b_)) wake = so_far + judge();
    }
  }

 private:
  // ---- the pair

  Vector3d end(const Line& line, std::size_t k) const {
    return position(nodes_, surface_.node[static_cast<std::size_t>(line.node[k])]);
  }
  Vector3d end_velocity(const Line& line, std::size_t k) const {
    return velocity(nodes_, surface_.node[static_cast<std::size_t>(line.node[k])]);
  }
  MovingEdge moving(const Line& line) const {
    MovingEdge edge{.start = {}, .displacement = {}, .radius = line.radius};
    for (std::size_t k = 0; k < 2; ++k) {
      edge.start[k] = end(line, k);
      edge.displacement[k] = travel_.dt() * (end_velocity(line, k) - frame_);
    }
    return edge;
  }

  // The shorter of both; of points the diameter.
  double length() const {
    const auto size = [&](const Line& line) {
      return line.is_point() ? 2 * line.radius : (end(line, 1) - end(line, 0)).norm();
    };
    const double first = size(*a_);
    const double second = size(*b_);
    if (a_->kind == LineKind::node) return second;
    if (b_->kind == LineKind::node) return first;
    return std::min(first, second);
  }

  void find_history() {
    const int slave = first_line_slave + number_;
    const auto begin = std::lower_bound(last_.begin(), last_.end(), slave,
                                        [](const Contact& c, int of) { return c.slave < of; });
    auto stop = begin;
    while (stop != last_.end() && stop->slave == slave) ++stop;
    history_ = {begin, stop};
  }
  const Contact* tracked() const {
    for (const Contact& old : history_)
      if (old.node[2] == b_->node[0] && old.node[3] == b_->node[1]) return &old;
    return nullptr;
  }

  // ---- small questions

  // Where a node of the line comes closest, its own check stands for it, unless no face is there to meet.
  bool stands_for_itself(SegmentFeature feature, const Line& line, const Line& other) const {
    if (feature == SegmentFeature::inside || line.is_point()) return true;
    if (line.continues[feature == SegmentFeature::first_end ? 0 : 1]) return true;
    return !line.is_edge() && !other.is_edge() && other.kind != LineKind::node;
  }
  bool is_here(const std::array<SegmentFeature, 2>& features) const {
    return stands_for_itself(features[0], *a_, *b_) && stands_for_itself(features[1], *b_, *a_);
  }

  // Whether a direction leads out of a line and no face is closer.
  bool leads_out(const Line& line, const Vector3d& direction, double beyond = flush) const {
    if (line.kind == LineKind::node)
      return surface_.of_solid[static_cast<std::size_t>(line.node[0])] == 0 ||
             looks_against(surface_, nodes_, line.node[0], -direction, 0);
    if (line.kind != LineKind::solid_edge) return true;
    const EdgeNormals at = normals_at(surface_, nodes_, line);
    return at.first.cross(direction).dot(at.along) > -beyond &&
           direction.cross(at.second).dot(at.along) > -beyond;
  }
  // The normal of the face of an edge of a solid that a direction out of it is close to.
  std::optional<Vector3d> face_along(const Line& line, const Vector3d& direction) const {
    const EdgeNormals at = normals_at(surface_, nodes_, line);
    if (at.first.cross(direction).dot(at.along) < flush) return at.first;
    if (direction.cross(at.second).dot(at.along) < flush) return at.second;
    return std::nullopt;
  }

  /// How a pair is pushed apart: the direction, the points of both lines that it leads from one to the other.
  struct Way {
    Vector3d normal;
    std::array<double, 2> at;
  };

  // What a direction found from the lines alone comes to; none if it leads not out of both. Where an edge
  // lies in a face of the other, that face tells the way.
  std::optional<Way> way_of(const Vector3d& direction, const std::array<double, 2>& at) const {
    const double beyond = tracked() != nullptr ? followed : flush;
    if (!leads_out(*b_, direction, beyond) || !leads_out(*a_, -direction, beyond)) return std::nullopt;
    if (a_->radius + b_->radius > 0) return Way{direction, at};
    const auto of_second = face_along(*b_, direction);
    const auto of_first = of_second ? std::nullopt : face_along(*a_, -direction);
    const bool in_face = of_first || of_second;
    const Vector3d normal = of_second ? *of_second : of_first ? Vector3d(-*of_first) : direction;
    const auto crossing = crossing_along(normal);
    if (!is_on(*a_, crossing[0], in_face) || !is_on(*b_, crossing[1], in_face)) return std::nullopt;
    return Way{normal, crossing};
  }

  bool is_on(const Line& line, double parameter, bool in_face) const {
    const double margin = in_face ? end_share : 0;
    return parameter >= (line.continues[0] ? -overlap_share : margin) &&
           parameter <= 1 + (line.continues[1] ? overlap_share : -margin);
  }

  // Where the lines cross as seen along a direction.
  std::array<double, 2> crossing_along(const Vector3d& normal) const {
    const Vector3d along_a = end(*a_, 1) - end(*a_, 0);
    const Vector3d along_b = end(*b_, 1) - end(*b_, 0);
    const Vector3d between = end(*b_, 0) - end(*a_, 0);
    const double area = along_a.cross(along_b).dot(normal);
    return {between.cross(along_b).dot(normal) / area, between.cross(along_a).dot(normal) / area};
  }

  bool are_parallel(double area) const {
    return area <= parallel * (end(*a_, 1) - end(*a_, 0)).norm() * (end(*b_, 1) - end(*b_, 0)).norm();
  }
  // Whether two edges of solids that have passed each other are inside of one another.
  bool are_inside(const Vector3d& normal) const {
    const EdgeNormals a = normals_at(surface_, nodes_, *a_);
    const EdgeNormals b = normals_at(surface_, nodes_, *b_);
    return std::max(a.first.dot(normal), a.second.dot(normal)) < flush &&
           std::min(b.first.dot(normal), b.second.dot(normal)) > -flush;
  }

  // From a point of b to one of a.
  Vector3d offset_at(const std::array<double, 2>& at) const {
    return (1 - at[0]) * end(*a_, 0) + at[0] * end(*a_, 1) - (1 - at[1]) * end(*b_, 0) - at[1] * end(*b_, 1);
  }
  Vector3d relative_velocity(const std::array<double, 2>& at) const {
    return (1 - at[0]) * end_velocity(*a_, 0) + at[0] * end_velocity(*a_, 1) -
           (1 - at[1]) * end_velocity(*b_, 0) - at[1] * end_velocity(*b_, 1);
  }

  // ---- judgement

  // \returns the path on which at least the pair cannot become near.
  double judge() {
    const Segment a{end(*a_, 0), end(*a_, 1)};
    const Segment b{end(*b_, 0), end(*b_, 1)};
    const ClosestSegments closest = closest_points_of_segments(a, b);
    const double distance = std::sqrt(closest.squared_distance);
    const double size = length();
    const double beyond = distance - a_->radius - b_->radius - band_share * size;
    if (join_closest(closest, distance, size)) return 0;  // however deep, it stays in sight
    if (options_.velocity_check && beyond > 0) join_meeting();
    return beyond - travel_.rounding();
  }

  // \returns whether the pair is joined.
  bool join_closest(const ClosestSegments& closest, double distance, double size) {
    const double reach = a_->radius + b_->radius;
    const Vector3d motion = relative_velocity(closest.parameters);
    const double look = approach_share * travel_.dt() * motion.norm();
    if (distance - reach > band_share * size + look) return false;
    if (reach > 0 && !is_here(closest.features)) return false;
    const auto apart = direction(closest, distance, size, motion);
    const auto way = apart ? way_of(*apart, closest.parameters) : std::nullopt;
    if (!way) return false;
    const Vector3d& normal = way->normal;
    const double gap = offset_at(way->at).dot(normal) - reach;
    if (gap < -reach - faces_.depth_share * size) return false;
    if (reach == 0 && gap < -touching_share * size && tracked() == nullptr && !are_inside(normal))
      return false;
    if (gap > band_share * size + approach_share * travel_.dt() * std::abs(motion.dot(normal))) return false;
    append(way->at, normal, gap);
    return true;
  }

  // From b to a, the way that they are pushed apart; none where it cannot be told.
  std::optional<Vector3d> direction(const ClosestSegments& closest, double distance, double size,
                                    const Vector3d& motion) const {
    const double area = closest.normal.norm();
    if (a_->radius + b_->radius == 0) return direction_across(closest.normal, area);
    const Contact* old = tracked();
    if (distance > direction_share * size) {
      const Vector3d apart = closest.offset / distance;
      return old != nullptr && old->normal.dot(apart) < 0 ? Vector3d(-apart) : apart;
    }
    if (old != nullptr) return old->normal;
    if (area == 0 && !a_->is_edge() && !b_->is_edge()) return any_way(motion);
    if (area == 0) return std::nullopt;
    const Vector3d across = closest.normal / area;
    return across.dot(motion) < 0 ? across : Vector3d(-across);
  }

  // Beams and particles that lie in one place: back the way that they came, or any.
  Vector3d any_way(const Vector3d& motion) const {
    const Vector3d along = end(*a_, 1) - end(*a_, 0);
    if (along.isZero(0))
      return motion.isZero(0) ? Vector3d(Vector3d::UnitX()) : Vector3d(-motion.normalized());
    const Vector3d across = motion - (motion.dot(along) / along.squaredNorm()) * along;
    return across.isZero(0) ? Vector3d(along.unitOrthogonal()) : Vector3d(-across.normalized());
  }

  // Edges of solids are pushed apart across both, from b to a; none where they are parallel.
  std::optional<Vector3d> direction_across(const Vector3d& normal, double area) const {
    if (are_parallel(area)) return std::nullopt;
    const Vector3d across = normal / area;
    if (const Contact* old = tracked()) return old->normal.dot(across) > 0 ? across : Vector3d(-across);
    return leads_out(*b_, across) ? across : Vector3d(-across);
  }

  void join_meeting() {
    const auto meeting = edge_check(moving(*a_), moving(*b_));
    if (!meeting || !is_here(meeting->features) || meeting->normal.squaredNorm() < 0.5) return;
    const double reach = a_->radius + b_->radius;
    const auto direction = reach > 0 ? std::optional(meeting->normal) : way_of_meeting(*meeting);
    if (!direction) return;
    const Vector3d& normal = *direction;
    // Where an edge lies in a face, it may be a seam of it that an upright edge seems to meet.
    if (!leads_out(*b_, normal) || !leads_out(*a_, -normal)) return;
    const bool in_face = reach == 0 && (face_along(*b_, normal) || face_along(*a_, -normal));
    if (in_face && (!is_on(*a_, meeting->parameters[0], true) || !is_on(*b_, meeting->parameters[1], true)))
      return;
    const double gap = offset_at(meeting->parameters).dot(normal) - reach;
    append(meeting->parameters, normal, std::max(gap, 0.0));
  }

  // Edges that meet where one of them ends, and goes on as another, came together any way, along the edge as
  // well: a seam of its mesh would hold up an edge that slides along.
  std::optional<Vector3d> way_of_meeting(const EdgeContact& meeting) const {
    const Vector3d normal = (end(*a_, 1) - end(*a_, 0)).cross(end(*b_, 1) - end(*b_, 0));
    const double area = normal.norm();
    if (are_parallel(area)) return std::nullopt;
    if (meeting.features[0] == SegmentFeature::inside && meeting.features[1] == SegmentFeature::inside)
      return meeting.normal;
    const double along = normal.dot(meeting.normal);
    if (std::abs(along) > flush * area) return along > 0 ? Vector3d(normal / area) : Vector3d(-normal / area);
    return direction_across(normal, area);
  }

  void append(std::array<double, 2> at, const Vector3d& normal, double gap) {
    // The node of a point counts once: both halves of it would seem twice as heavy.
    if (a_->is_point()) at[0] = 0;
    if (b_->is_point()) at[1] = 0;
    Contact contact;
    contact.slave = first_line_slave + number_;
    contact.face = -1;
    contact.body = b_->body;
    contact.own = 2;
    contact.node = {a_->node[0], a_->node[1], b_->node[0], b_->node[1], b_->node[1]};
    contact.weight = {1 - at[0], at[0], at[1] - 1, -at[1], 0};
    contact.normal = normal;
    contact.gap = gap;
    contact.friction_coefficient = surface_.pairs.friction_of_parts(a_->part, b_->part, options_.friction);
    found_.push_back(contact);
  }

  LineCandidates& candidates_;
  const Surface& surface_;
  const ContactOptions& options_;
  const Candidates& faces_;
  const Nodes& nodes_;
  const Travel& travel_;
  std::span<const Contact> last_;
  std::vector<Contact>& found_;
  Vector3d frame_;
  std::span<const Contact> history_;
  int number_ = 0;
  const Line* a_ = nullptr;
  const Line* b_ = nullptr;
};

}  // namespace

void renumber(const LineCandidates& candidates, std::vector<Contact>& contacts) {
  const auto begin = std::find_if(contacts.begin(), contacts.end(),
                                  [](const Contact& contact) { return contact.of_lines(); });
  const auto gone = std::remove_if(begin, contacts.end(), [&](Contact& contact) {
    const std::array<int, 2> node{contact.node[0], contact.node[1]};
    const auto at = std::lower_bound(candidates.line.begin(), candidates.line.end(), node,
                                     [](const Line& line, const auto& of) { return line.node < of; });
    contact.slave = first_line_slave + static_cast<int>(at - candidates.line.begin());
    return at == candidates.line.end() || at->node != node;
  });
  contacts.erase(gone, contacts.end());
}

void detect_lines(LineContacts& lines, const Surface& surface, const ContactOptions& options,
                  const Candidates& faces, const Nodes& nodes, const Travel& travel,
                  std::span<const Contact> last, ThreadTeam& team, std::vector<Contact>& contacts) {
  LineCandidates& candidates = lines.candidates;
  const std::size_t count = candidates.line.size();
  if (candidates.partners.item.empty()) return;
  follow_lines(candidates, travel);
  const std::size_t tasks = (count + lines_per_task - 1) / lines_per_task;
  lines.piece.resize(std::max(tasks, lines.piece.size()));
  team.for_each(tasks, [&](std::size_t task) {
    std::vector<Contact>& found = lines.piece[task];
    found.clear();
    LineCheck check(candidates, surface, options, faces, nodes, travel, last, found);
    const std::size_t end = std::min(count, (task + 1) * lines_per_task);
    for (std::size_t l = task * lines_per_task; l < end; ++l) check.run(static_cast<int>(l));
  });
  for (std::size_t task = 0; task < tasks; ++task)
    contacts.insert(contacts.end(), lines.piece[task].begin(), lines.piece[task].end());
}

}  // namespace brio
