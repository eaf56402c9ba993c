#include "contact/enforcement/nodes_at_walls.hpp"

#include <algorithm>
#include <tuple>

namespace brio {

namespace {

bool comes_before(const NodeAtWall& a, const NodeAtWall& b) {
  return std::tie(a.wall, a.slave) < std::tie(b.wall, b.slave);
}

struct Heights {
  double start, end;
};
Heights heights_of(const ContactWall& wall, const FeatureMotion& motion, std::size_t slave, double dt) {
  const Vector3d start = vector_at(motion.node[slave].start), end = vector_at(motion.node[slave].end);
  return {dot(wall.normal, start - wall.point), dot(wall.normal, end - wall.point - dt * wall.velocity)};
}

}  // namespace

void NodesAtWalls::find(std::span<const ContactWall> walls, const Surface& surface,
                        const FeatureMotion& motion, double dt, double band, double step_ratio) {
  std::swap(touch, last);
  std::sort(last.begin(), last.end(), comes_before);
  touch.clear();
  const std::size_t slaves = surface.slaves();
  touches.assign(walls.size() * slaves, 0);
  auto known = last.begin();
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (std::size_t s = 0; s < slaves; ++s) {
      if (surface.node[s] < 0) continue;
      const auto [start, end] = heights_of(walls[w], motion, s, dt);
      if (!(start <= band + approach_factor * std::abs(end - start))) continue;
      NodeAtWall one{.wall = static_cast<int>(w), .slave = static_cast<int>(s)};
      while (known != last.end() && comes_before(*known, one)) ++known;
      if (known != last.end() && !comes_before(one, *known)) {
        one.impulse = step_ratio * known->impulse;
        one.friction = step_ratio * known->friction;
      }
      touches[w * slaves + s] = 1;
      touch.push_back(one);
    }
}

bool NodesAtWalls::find_missed(std::span<const ContactWall> walls, const Surface& surface,
                               const FeatureMotion& motion, double dt, double tolerance) {
  const std::size_t slaves = surface.slaves(), known = touch.size();
  for (std::size_t w = 0; w < walls.size(); ++w)
    for (std::size_t s = 0; s < slaves; ++s) {
      if (surface.node[s] < 0 || touches[w * slaves + s] != 0) continue;
      if (heights_of(walls[w], motion, s, dt).end >= -tolerance) continue;
      touches[w * slaves + s] = 1;
      touch.push_back({.wall = static_cast<int>(w), .slave = static_cast<int>(s)});
    }
  return touch.size() > known;
}

void project_wall_rows(ConstraintRows& rows, std::span<VelocityBlock> blocks) {
  for (ConstraintRow& row : rows.row) {
    if (row.wall < 0) continue;
    const RowMap map(rows, row);
    const double missing = row.target_velocity - dot(row.normal, map.relative_velocity(blocks));
    if (!(missing > 0)) continue;
    const double inverse = map.inverse_mass(row.normal, blocks);
    if (!(inverse > 0)) continue;
    const double impulse = missing / inverse;
    row.impulse += impulse;
    map.spread(impulse * row.normal, [&](int block, const Vector3d& given) {
      VelocityBlock& moved = blocks[index(block)];
      moved.velocity += moved.inverse_mass * given;
    });
  }
}

}  // namespace brio
