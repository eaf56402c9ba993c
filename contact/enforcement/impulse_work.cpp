#include "contact/enforcement/impulse_work.hpp"

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t rows_a_part = 512;

Vector3d diagonal(const SymmetricTensor<double>& a) { return {a.xx, a.yy, a.zz}; }
Vector3d where_zero(const Vector3d& chosen, const Vector3d& value) {
  return {chosen.x == 0 ? value.x : 0, chosen.y == 0 ? value.y : 0, chosen.z == 0 ? value.z : 0};
}

// Minus the impulse on the prescribed components; of a body, that on the free ones acts on the others as
// well.
Vector3d reaction_of(const VelocityBlock& block, const BlockPlace& place, const Vector3d& given) {
  Vector3d left = Vector3d{0, 0, 0} - given;
  const Vector3d change = block.inverse_mass * given;
  if (place.inertia != nullptr) left = left + *place.inertia * change;
  if (place.skew) return left + place.mass * change;
  return where_zero(diagonal(block.inverse_mass), left);
}

bool is_free(const VelocityBlock& block, const BlockPlace& place) {
  const SymmetricTensor<double>& a = block.inverse_mass;
  return !place.skew && a.xx != 0 && a.yy != 0 && a.zz != 0;
}

void account_supports(const RowMap& map, const Vector3d& impulse, std::span<const Vector3d> before,
                      std::span<const VelocityBlock> after, std::span<const BlockPlace> places,
                      RowWork& work) {
  map.spread(impulse, [&](int b, const Vector3d& given) {
    const VelocityBlock& block = after[index(b)];
    if (is_free(block, places[index(b)])) return;
    const Vector3d reaction = reaction_of(block, places[index(b)], given);
    work.support_before += dot(reaction, before[index(b)]);
    work.support_after += dot(reaction, block.velocity);
    if (places[index(b)].turns) {
      work.support_moment = work.support_moment + reaction;
    } else {
      work.support_impulse = work.support_impulse + reaction;
      work.support_moment = work.support_moment + cross(places[index(b)].position, reaction);
    }
  });
}

void account_row(const ConstraintRows& rows, ConstraintRow& row, std::span<const Vector3d> before,
                 std::span<const VelocityBlock> after, std::span<const BlockPlace> places, RowWork& work) {
  const RowMap map(rows, row);
  const Vector3d was = map.velocity([&](int b) { return before[index(b)]; }) - row.wall_velocity;
  const Vector3d is = map.relative_velocity(after);
  const double normal_before = row.impulse * dot(row.normal, was);
  const double normal_after = row.impulse * dot(row.normal, is);
  row.normal_work = 0.5 * (normal_before + normal_after);
  work.normal_before += normal_before;
  work.normal_after += normal_after;
  work.friction_before += dot(row.friction, was);
  work.friction_after += dot(row.friction, is);
  work.walls += dot(impulse_of(row), row.wall_velocity);
  account_supports(map, impulse_of(row), before, after, places, work);
}

void sum_at_walls(const ConstraintRows& rows, std::span<ImpulseOnWall> walls) {
  for (const ConstraintRow& row : rows.row) {
    if (row.wall < 0) continue;
    const Vector3d impulse = impulse_of(row);
    ImpulseOnWall& wall = walls[index(row.wall)];
    wall.impulse = wall.impulse - impulse;
    wall.moment = wall.moment - cross(row.point, impulse);
  }
}

}  // namespace

RowWork& RowWork::operator+=(const RowWork& other) {
  normal_before += other.normal_before;
  normal_after += other.normal_after;
  friction_before += other.friction_before;
  friction_after += other.friction_after;
  support_before += other.support_before;
  support_after += other.support_after;
  support_impulse = support_impulse + other.support_impulse;
  support_moment = support_moment + other.support_moment;
  walls += other.walls;
  return *this;
}

RowWork account_work(ConstraintRows& rows, std::span<const Vector3d> before,
                     std::span<const VelocityBlock> after, std::span<const BlockPlace> places,
                     std::span<ImpulseOnWall> walls, std::vector<RowWork>& parts, ThreadTeam& team) {
  parts.assign((rows.size() + rows_a_part - 1) / rows_a_part, {});
  team.for_ranges(rows.size(), rows_a_part, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (rows.row[i].impulse != 0)
        account_row(rows, rows.row[i], before, after, places, parts[begin / rows_a_part]);
  });
  if (!walls.empty()) sum_at_walls(rows, walls);
  RowWork work;
  for (const RowWork& part : parts) work += part;
  return work;
}

void sum_reactions(const ConstraintRows& rows, std::span<const VelocityBlock> after,
                   std::span<const BlockPlace> places, std::span<Vector3d> reaction) {
  for (const ConstraintRow& row : rows.row) {
    if (row.impulse == 0) continue;
    RowMap(rows, row).spread(impulse_of(row), [&](int b, const Vector3d& given) {
      const VelocityBlock& block = after[index(b)];
      if (!is_free(block, places[index(b)]))
        reaction[index(b)] = reaction[index(b)] + reaction_of(block, places[index(b)], given);
    });
  }
}

}  // namespace brio
