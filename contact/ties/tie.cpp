#include "contact/ties/tie.hpp"

#include <algorithm>
#include <cmath>

namespace brio {

namespace {

constexpr int most_iterations = 50;
/// Newton's method has converged once coordinates change by less than this.
constexpr double converged = 1e-14;
/// Gaps below this share of the face's size are rounding.
constexpr double rounding_share = 1e-12;
/// Coordinates this far outside are not worth following.
constexpr double far_outside = 4;

void set_weights(Tie& tie, double u, double v, bool triangle) {
  if (triangle) {
    tie.weight = {1 - u - v, u, v, 0};
    tie.along = {-1, 1, 0, 0};
    tie.across = {-1, 0, 1, 0};
    return;
  }
  tie.weight = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  tie.along = {-(1 - v), 1 - v, v, -v};
  tie.across = {-(1 - u), -u, u, 1 - u};
}

// Formed from differences, which are exact also far from the origin; the weights sum to 0 or 1.
Vector3d combine(const std::array<double, 4>& weight, const FaceVertices& face) {
  return weight[1] * (face[1] - face[0]) + weight[2] * (face[2] - face[0]) + weight[3] * (face[3] - face[0]);
}

Vector3d normal_of(const Vector3d& along, const Vector3d& across) {
  return unit_or(cross(along, across), Vector3d{});
}

bool is_inside(double u, double v, bool triangle) {
  if (u < -beyond_edge || v < -beyond_edge) return false;
  if (triangle) return u + v <= 1 + beyond_edge;
  return u <= 1 + beyond_edge && v <= 1 + beyond_edge;
}

}  // namespace

// Newton's method for (node - x(u, v)) . x_u = (node - x(u, v)) . x_v = 0; for a triangle it is one step.
std::optional<Tie> project(const Vector3d& node, const FaceVertices& face) {
  const bool triangle = is_triangle(face);
  const Vector3d twist = triangle ? Vector3d{} : (face[0] - face[1]) + (face[2] - face[3]);  // x_uv
  double u = triangle ? 1.0 / 3 : 0.5;
  double v = u;
  Tie tie;
  for (int i = 0; i < most_iterations; ++i) {
    set_weights(tie, u, v, triangle);
    const Vector3d g = combine(tie.along, face);
    const Vector3d h = combine(tie.across, face);
    const Vector3d away = (node - face[0]) - combine(tie.weight, face);
    // Far from a warped face the second derivative would make the system singular: left out there.
    const double twisted =
        squared_norm(cross(g, h)) > 4 * std::pow(dot(away, twist), 2) ? dot(away, twist) : 0;
    const double gg = dot(g, g);
    const double hh = dot(h, h);
    const double gh = dot(g, h) - twisted;
    const double determinant = gg * hh - gh * gh;
    if (!(determinant > 0)) return {};
    const double du = (hh * dot(away, g) - gh * dot(away, h)) / determinant;
    const double dv = (gg * dot(away, h) - gh * dot(away, g)) / determinant;
    u += du;
    v += dv;
    if (!(std::abs(u) < far_outside && std::abs(v) < far_outside)) return {};
    if (std::max(std::abs(du), std::abs(dv)) < converged) break;
    if (i + 1 == most_iterations) return {};
  }
  if (!is_inside(u, v, triangle)) return {};
  set_weights(tie, u, v, triangle);
  const Vector3d away = (node - face[0]) - combine(tie.weight, face);
  tie.gap = dot(away, normal_at(tie, face));
  const double size = std::max(norm(combine(tie.along, face)), norm(combine(tie.across, face)));
  if (std::abs(tie.gap) < rounding_share * (size + norm(face[0]))) tie.gap = 0;
  return tie;
}

Vector3d normal_at(const Tie& tie, const FaceVertices& face) {
  return normal_of(combine(tie.along, face), combine(tie.across, face));
}

// With g = sum a_k x_k, h = sum b_k x_k and N = g x h, the normal n = N/|N| changes by (1 - n n) dN / |N|.
Vector3d normal_rate(const Tie& tie, const FaceVertices& face, const FaceVertices& velocity) {
  const Vector3d g = combine(tie.along, face);
  const Vector3d h = combine(tie.across, face);
  const Vector3d area = cross(g, h);
  const double size = norm(area);
  const Vector3d normal = area / size;
  const Vector3d rate = cross(combine(tie.along, velocity), h) + cross(g, combine(tie.across, velocity));
  return (rate - dot(normal, rate) * normal) / size;
}

Vector3d point_on(const Tie& tie, const FaceVertices& face) { return face[0] + combine(tie.weight, face); }

Vector3d tied_position(const Tie& tie, const FaceVertices& face) {
  const Vector3d point = point_on(tie, face);
  if (tie.turning) return point + tie.arm;
  return tie.gap == 0 ? point : Vector3d(point + tie.gap * normal_at(tie, face));
}

// The transpose of normal_rate.
std::array<Vector3d, 4> spread(const Tie& tie, const FaceVertices& face, const Vector3d& force) {
  std::array<Vector3d, 4> share;
  for (std::size_t k = 0; k < 4; ++k) share[k] = tie.weight[k] * force;
  if (tie.turning || tie.gap == 0) return share;
  const Vector3d g = combine(tie.along, face);
  const Vector3d h = combine(tie.across, face);
  const Vector3d area = cross(g, h);
  const double size = norm(area);
  const Vector3d normal = area / size;
  const Vector3d in_plane = (tie.gap / size) * (force - dot(normal, force) * normal);
  const Vector3d by_along = cross(h, in_plane);
  const Vector3d by_across = cross(in_plane, g);
  for (std::size_t k = 0; k < 4; ++k) share[k] += tie.along[k] * by_along + tie.across[k] * by_across;
  return share;
}

std::array<double, 4> largest_share(const Tie& tie, const FaceVertices& face) {
  std::array<double, 4> share;
  for (std::size_t k = 0; k < 4; ++k) share[k] = std::abs(tie.weight[k]);
  if (tie.turning || tie.gap == 0) return share;
  const Vector3d g = combine(tie.along, face);
  const Vector3d h = combine(tie.across, face);
  const double tilt = std::abs(tie.gap) / norm(cross(g, h));
  for (std::size_t k = 0; k < 4; ++k)
    share[k] += tilt * (std::abs(tie.along[k]) * norm(h) + std::abs(tie.across[k]) * norm(g));
  return share;
}

// Rodrigues' formula, with factors that are regular for small angles.
Vector3d turned_by(const Vector3d& rotation, const Vector3d& vector) {
  const double angle = norm(rotation);
  const double half = std::sin(0.5 * angle);
  const double first = angle > 0 ? std::sin(angle) / angle : 1;
  const double second = angle > 0 ? 2 * half * half / (angle * angle) : 0.5;
  const Vector3d turn = cross(rotation, vector);
  return vector + first * turn + second * cross(rotation, turn);
}

}  // namespace brio
