#include "src/motion/skew_supports.hpp"

#include <algorithm>
#include <span>
#include <sstream>
#include <tuple>

#include "src/base/breakdown.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Angle, in radians, below which directions are one: numbers of a deck are rounded. ...
constexpr double same_direction = 1e-6;
/// ... and above which they are two: in between, two supports would hold a third direction by accident.
constexpr double other_direction = 1e-3;

/// Independent directions of a node, at most three.
struct Basis {
  int count = 0;
  Tensor<double> direction{}, orthonormal{};  ///< rows
};

[[noreturn]] void refuse(const PrescribedNodes& given, const double* x) {
  std::ostringstream text;
  text << "the motion of the node at (" << x[0] << ", " << x[1] << ", " << x[2]
       << ") is prescribed along directions that are nearly the same, or nearly in one plane; accepted are "
          "equal ones (within "
       << same_direction << " radian) and such as differ by " << other_direction << " radian or more";
  throw BuildError(text.str(), given.place);
}

/// \return whether the direction is not in the span of those before.
bool take(Basis& basis, const Vector3d& direction, const PrescribedNodes& given, const double* position) {
  Vector3d left = direction;
  for (int again = 0; again < 2; ++again)  // Gram and Schmidt; the second time for what rounding left
    for (int k = 0; k < basis.count; ++k)
      left -= dot(basis.orthonormal.row(k), left) * basis.orthonormal.row(k);
  const double size = basis.count == 3 ? 0 : norm(left);
  if (size < same_direction) return false;
  if (size < other_direction) refuse(given, position);
  basis.direction.set_row(basis.count, direction);
  basis.orthonormal.set_row(basis.count, basis.count == 0 ? direction : left / size);
  ++basis.count;
  return true;
}

/// Rows: the dual basis of the directions, within their span.
Tensor<double> duals_of(const Basis& basis) {
  if (basis.count == 1) return basis.direction;
  const Vector3d a = basis.direction.row(0), b = basis.direction.row(1);
  const Vector3d c = basis.count == 3 ? basis.direction.row(2) : cross(a, b);
  Tensor<double> duals =
      transposed(inverse(Tensor<double>{{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}}));
  if (basis.count == 2) duals.set_row(2, {});
  return duals;
}

Tensor<double> axes_of(Basis basis) {
  if (basis.count == 0) return identity<double>();
  Tensor<double>& axes = basis.orthonormal;
  if (basis.count == 1) axes.set_row(1, unit_at_right_angles(axes.row(0)));
  if (basis.count <= 2) axes.set_row(2, cross(axes.row(0), axes.row(1)));
  return axes;
}

SupportAxes& own_axes_of(int node, Nodes& nodes) {
  if (nodes.axes_of.empty()) nodes.axes_of.assign(nodes.size(), -1);
  int& own = nodes.axes_of[index(node)];
  if (own < 0) {
    own = static_cast<int>(nodes.support_axes.size());
    nodes.support_axes.push_back({identity<double>(), identity<double>()});
  }
  return nodes.support_axes[index(own)];
}

void mark(int node, int bits, Nodes& nodes) {
  nodes.prescribed[index(node)] |= static_cast<std::uint8_t>(bits);
}

/// All supports of one node, of translations or of rotations.
void combine(std::span<const SupportPlace> places, std::vector<PrescribedNodes>& prescribed, Nodes& nodes) {
  Basis basis;
  std::vector<Vector3d*> dual;
  const int node = places.front().node;
  for (const SupportPlace& place : places) {
    PrescribedNodes& given = prescribed[place.entry];
    given.dual[place.at] = {};
    if (take(basis, given.direction[place.at], given, nodes.record[index(node)].position))
      dual.push_back(&given.dual[place.at]);
  }
  const Tensor<double> duals = duals_of(basis);
  for (std::size_t k = 0; k < dual.size(); ++k) *dual[k] = duals.row(k);
  const bool turns = prescribed[places.front().entry].turns();
  SupportAxes& own = own_axes_of(node, nodes);
  (turns ? own.angular : own.linear) = axes_of(basis);
  mark(node, ((1 << basis.count) - 1) << (turns ? 3 : 0), nodes);
}

/// Supports along global axes of nodes that have a skew one as well become skew ones.
void part_entries(std::vector<PrescribedNodes>& prescribed, bool turns, std::size_t node_count) {
  const auto concerned = [&](const PrescribedNodes& given) { return given.turns() == turns; };
  std::vector<std::uint8_t> skew;
  for (const PrescribedNodes& given : prescribed) {
    if (!given.is_skew() || !concerned(given)) continue;
    skew.resize(node_count);
    for (const int node : given.nodes) skew[index(node)] = 1;
  }
  if (skew.empty()) return;
  const auto is_skew = [&](int node) { return skew[index(node)] != 0; };
  std::vector<PrescribedNodes> parted;
  for (PrescribedNodes& given : prescribed) {
    PrescribedNodes own = given;
    if (concerned(given) && !given.is_skew()) {
      std::erase_if(own.nodes, [&](int node) { return !is_skew(node); });
      std::erase_if(given.nodes, is_skew);
    } else {
      own.nodes.clear();
    }
    parted.push_back(std::move(given));
    if (own.nodes.empty()) continue;
    own.direction.assign(own.nodes.size(), own.direction_of(0));
    parted.push_back(std::move(own));
  }
  std::erase_if(parted, [](const PrescribedNodes& given) { return given.nodes.empty(); });
  prescribed = std::move(parted);
}

}  // namespace

std::vector<SupportPlace> skew_places(const std::vector<PrescribedNodes>& prescribed, bool turns) {
  std::vector<SupportPlace> places;
  for (std::size_t entry = 0; entry < prescribed.size(); ++entry)
    if (prescribed[entry].is_skew() && prescribed[entry].turns() == turns)
      for (std::size_t at = 0; at < prescribed[entry].nodes.size(); ++at)
        places.push_back({prescribed[entry].nodes[at], entry, at});
  std::ranges::sort(places, {}, [](const SupportPlace& one) { return std::tuple(one.node, one.entry); });
  return places;
}

void combine_supports(std::vector<PrescribedNodes>& prescribed, Nodes& nodes) {
  if (prescribed.empty()) return;
  nodes.prescribed = AlignedBuffer<std::uint8_t>(nodes.size());
  nodes.axes_of.clear();
  nodes.support_axes.clear();
  for (const bool turns : {false, true}) part_entries(prescribed, turns, nodes.size());
  for (PrescribedNodes& given : prescribed) {
    if (!given.is_skew())
      for (const int node : given.nodes) mark(node, 1 << given.axis, nodes);
    given.dual.resize(given.direction.size());
    given.impulse.resize(given.direction.size());
  }
  for (const bool turns : {false, true}) {
    const std::vector<SupportPlace> places = skew_places(prescribed, turns);
    for (auto begin = places.begin(); begin != places.end();) {
      const auto end =
          std::find_if(begin, places.end(), [&](const SupportPlace& one) { return one.node != begin->node; });
      combine({begin, end}, prescribed, nodes);
      begin = end;
    }
  }
}

void release(PrescribedNodes& given, int node) {
  const auto at = std::lower_bound(given.nodes.begin(), given.nodes.end(), node) - given.nodes.begin();
  given.nodes.erase(given.nodes.begin() + at);
  if (given.is_skew()) given.direction.erase(given.direction.begin() + at);
}

}  // namespace brio
