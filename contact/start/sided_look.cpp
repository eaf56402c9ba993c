#include "contact/start/sided_look.hpp"

#include "src/base/index.hpp"

namespace brio {

void Directions::add(const Vector3d& direction) {
  const bool is_known = std::any_of(known_.begin(), known_.end(), [&](const Vector3d& known) {
    return dot(known, direction) > same_cosine;
  });
  if (is_known || !(squared_norm(direction) > 0.5)) return;
  known_.push_back(direction);
  sum_ += direction;
}

SidedLook::SidedLook(const SurfaceFeatures& surface_features, const Surface& of, const Nodes& at_rest,
                     const SearchedDepth& searched_depth)
    : features(surface_features),
      surface(of),
      nodes(at_rest),
      depth(searched_depth),
      part_(surface.slaves(), 0) {
  for (const RoundElement& round : surface.round)
    if (round.alive())
      for (int node : round.node) part_[index(surface.slave(node))] = round.part;
  for (int s = 0; s < static_cast<int>(surface.slaves()); ++s)
    if (const auto faces = surface.faces_of.of(s); !faces.empty())
      part_[index(s)] = surface.face[index(faces.front())].part;
}

bool SidedLook::surely_farther(int slave, const Face& face, double distance) const {
  const double* x = nodes.record[index(surface.node[index(slave)])].position;
  for (int axis = 0; axis < 3; ++axis) {
    double least = infinity, most = -infinity;
    for (int corner : face.node) {
      const double c = nodes.record[index(corner)].position[axis];
      least = std::min(least, c);
      most = std::max(most, c);
    }
    if (x[axis] < least - distance || x[axis] > most + distance) return true;
  }
  return false;
}

bool SidedLook::is_before(int slave, const Vector3d& normal) const {
  const Vector3d x = at(slave);
  const auto ring = features.ring.of(slave);
  return std::all_of(ring.begin(), ring.end(), [&](int neighbour) {
    const Vector3d arm = at(neighbour) - x;
    return dot(arm, normal) >= -behind_sine * norm(arm);
  });
}

Vector3d SidedLook::side_of(int slave, const Face& face, const Vector3d& normal) const {
  if (is_before(slave, normal)) return normal;
  return face.shell && is_before(slave, -normal) ? -normal : Vector3d{};
}

bool SidedLook::is_minimum(int f, const std::array<double, 4>& weights, const Vector3d& foot,
                           const Vector3d& normal, std::array<int, 2>& support) const {
  const Face& own = surface.face[index(f)];
  std::array<std::size_t, 4> on{};
  std::size_t count = 0;
  const auto corners = index(own.corners());
  for (std::size_t k = 0; k < corners; ++k)
    if (weights[k] > no_weight) on[count++] = k;
  const auto slave = [&](std::size_t k) { return surface.slave(own.node[k]); };
  if (count == 1) {
    support = {slave(on[0]), -1};
    return look_away(features.ring.of(slave(on[0])), foot, -normal);
  }
  support = {-2 - f, -1};
  if (count != 2 || (corners == 4 && on[1] == on[0] + 2)) return true;
  const std::size_t side = on[1] == on[0] + 1 ? on[0] : on[1];
  support = {std::min(slave(on[0]), slave(on[1])), std::max(slave(on[0]), slave(on[1]))};
  return look_away(edge(features.edge_of_face[index(f)][side]).wing, foot, -normal);
}

bool SidedLook::is_minimum(int e, double parameter, const Vector3d& foot, const Vector3d& away,
                           int& support) const {
  const EdgeFeature& own = edge(e);
  support = e;
  if (own.is_point()) return true;
  const bool inside = parameter > no_weight && parameter < 1 - no_weight;
  if (inside) return own.faces > 2 || look_away(own.wing, foot, away);
  if (own.of_face()) return false;
  const int end = own.node[parameter > 0.5 ? 1 : 0];
  support = -2 - end;
  return look_away(features.ring.of(end), foot, away);
}

}  // namespace brio
