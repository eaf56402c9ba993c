#include "contact/features/face_flatness.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

using Eigen::Vector3d;
using Corners = std::array<Vector3d, 4>;

namespace {

constexpr double share_of_skin = 0.1, share_of_radius = 0.03;
/// Of the thickness up to which a face stays flat, so that it does not change at every search.
constexpr double share_to_become_flat = 0.5;
constexpr std::size_t faces_a_range = 2048;

Corners at_start(const SurfaceFeatures& features, std::size_t face, const FeatureMotion& motion) {
  const std::array<int, 4>& corner = features.face_node[face];
  return {motion.start(corner[0]), motion.start(corner[1]), motion.start(corner[2]), motion.start(corner[3])};
}
Corners at_end(const SurfaceFeatures& features, std::size_t face, const FeatureMotion& motion) {
  const std::array<int, 4>& corner = features.face_node[face];
  return {motion.end(corner[0]), motion.end(corner[1]), motion.end(corner[2]), motion.end(corner[3])};
}

Flatness flatness_of(const SurfaceFeatures& features, std::size_t face, const FeatureMotion& motion) {
  const Corners start = at_start(features, face, motion), end = at_end(features, face, motion);
  for (const Flatness flatness : {Flatness::all, Flatness::radii}) {
    const double thickness = share_to_become_flat * flat_thickness(features, face, flatness);
    if (flat_slack(start, thickness).least() > 0 && flat_slack(end, thickness).least() > 0) return flatness;
  }
  return Flatness::none;
}

// The hull is no thicker: its thickness is the distance of the lines along the diagonals, this that of their
// middles.
double between_middles(const Corners& at) { return 0.5 * (at[0] - at[1] + at[2] - at[3]).norm(); }

// Take over the shape at the start of the step. \returns whether the face may bend in it
template <class Until, class May>
bool renew(Until& until, const Corners& start, double thickness, double path, const May& may) {
  const FlatSlack slack = flat_slack(start, thickness);
  until = {path + slack.thin, path + slack.convex};
  return may(path + slack.least());
}

}  // namespace

double flat_thickness(const SurfaceFeatures& features, std::size_t face, Flatness flatness) {
  const double for_all = share_of_skin * features.skin;
  return flatness == Flatness::all ? for_all
                                   : std::max(for_all, share_of_radius * features.face_radius[face]);
}

FlatSlack flat_slack(const Corners& at, double thickness) {
  const Vector3d a = at[2] - at[0], b = at[3] - at[1];
  const Vector3d across = a.cross(b);
  const double area = across.norm();
  if (!(area > 0)) return {-1, -1};
  const double hull = std::abs((at[1] - at[0]).dot(across)) / area;
  // Of each corner from the other diagonal, in the mean plane.
  const auto beside = [&](const Vector3d& diagonal, const Vector3d& arm) {
    return diagonal.cross(arm).dot(across) / (diagonal.norm() * area);
  };
  const double convex = std::min({beside(a, at[3] - at[0]), -beside(a, at[1] - at[0]),
                                  beside(b, at[0] - at[1]), -beside(b, at[2] - at[1])});
  return {0.5 * (thickness - hull), 0.25 * convex};
}

void FaceFlatness::forget(std::size_t faces) {
  flat_.assign(faces, Flatness::none);
  until_.assign(faces, {});
}

void FaceFlatness::measure(const SurfaceFeatures& features, const FeatureMotion& motion) {
  forget(features.diagonal_of_face.size());
  for (std::size_t f = 0; f < flat_.size(); ++f)
    if (features.diagonal_of_face[f][0] >= 0) flat_[f] = flatness_of(features, f, motion);
}

void FaceFlatness::change(std::size_t faces, std::span<const int> changed) {
  flat_.resize(faces, Flatness::none);
  until_.resize(faces, {});
  for (int f : changed) flat_[index(f)] = Flatness::none;
}

// Paths and looks ahead are of the prediction; of corners that contact has moved, where it has taken them.
bool FaceFlatness::may_reach(double path, const SurfaceFeatures& features, std::size_t face,
                             const FeatureMotion& motion) {
  if (motion.of_face.ahead[face] > path) return true;
  const double left = path - motion.of_face.path[face];
  const std::array<int, 4>& corner = features.face_node[face];
  return std::any_of(corner.begin(), corner.end(),
                     [&](int slave) { return motion.is_corrected(slave) && !motion.is_within(slave, left); });
}

bool FaceFlatness::may_bend(const SurfaceFeatures& features, int face, const FeatureMotion& motion) const {
  const auto f = index(face);
  return flat_[f] != Flatness::none &&
         may_reach(std::min(until_[f].thin, until_[f].convex), features, f, motion);
}

bool FaceFlatness::bends(const SurfaceFeatures& features, int face, const FeatureMotion& motion) {
  if (!may_bend(features, face, motion)) return false;
  const auto f = index(face);
  Until& until = until_[f];
  const auto may = [&](double path) { return may_reach(path, features, f, motion); };
  const double thickness = flat_thickness(features, f, flat_[f]), path = motion.of_face.path[f];
  const Corners start = at_start(features, f, motion), end = at_end(features, f, motion);
  if (!may(until.convex)) {
    until.thin = path + 0.5 * (thickness - between_middles(start));
    if (!may(until.thin) || between_middles(end) <= thickness) return false;
  }
  return renew(until, start, thickness, path, may) && !(flat_slack(end, thickness).least() >= 0);
}

bool FaceFlatness::any_bends(const SurfaceFeatures& features, const FeatureMotion& motion, ThreadTeam& team) {
  std::atomic<bool> any = false;
  team.for_ranges(flat_.size(), faces_a_range, [&](std::size_t begin, std::size_t end) {
    bool bent = false;
    for (std::size_t f = begin; f < end; ++f) {
      const bool may =
          flat_[f] != Flatness::none &&
          (motion.is_solution() || motion.of_face.ahead[f] > std::min(until_[f].thin, until_[f].convex));
      if (may) bent = bends(features, static_cast<int>(f), motion) || bent;
    }
    if (bent) any.store(true, std::memory_order_relaxed);
  });
  return any;
}

void FaceFlatness::take_over(const SurfaceFeatures& features, const FeatureMotion& motion, std::uint8_t mark,
                             std::vector<std::uint8_t>& flags, ThreadTeam& team) {
  const auto has_changed = [&](std::size_t f) {
    const auto may = [&](double path) { return may_reach(path, features, f, motion); };
    if (flat_[f] == Flatness::none || !may(std::min(until_[f].thin, until_[f].convex))) return false;
    if (!renew(until_[f], at_start(features, f, motion), flat_thickness(features, f, flat_[f]),
               motion.of_face.path[f], may))
      return false;
    const Flatness now = flatness_of(features, f, motion);
    return now > std::exchange(flat_[f], std::max(now, flat_[f]));
  };
  team.for_ranges(flat_.size(), faces_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      if (has_changed(f)) flags[f] |= mark;
  });
}

}  // namespace brio
