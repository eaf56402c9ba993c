#include "contact/enforcement/impulse_work.hpp"

namespace brio {

using Vector = Vector3<double>;

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

Vector diagonal(const SymmetricTensor<double>& a) { return {a.xx, a.yy, a.zz}; }
Vector where_zero(const Vector& chosen, const Vector& value) {
  return {chosen.x == 0 ? value.x : 0, chosen.y == 0 ? value.y : 0, chosen.z == 0 ? value.z : 0};
}

// Minus the impulse on the prescribed components; of a body, that on the free ones acts on the others as
// well.
Vector reaction_of(const VelocityBlock& block, const BlockPlace& place, const Vector& given) {
  Vector left = Vector{0, 0, 0} - given;
  const Vector change = block.inverse_mass * given;
  if (place.inertia != nullptr) left = left + *place.inertia * change;
  if (place.skew) return left + place.mass * change;
  return where_zero(diagonal(block.inverse_mass), left);
}

bool is_free(const VelocityBlock& block, const BlockPlace& place) {
  const SymmetricTensor<double>& a = block.inverse_mass;
  return !place.skew && a.xx != 0 && a.yy != 0 && a.zz != 0;
}

void account_supports(const RowMap& map, const Vector& impulse, std::span<const Vector> before,
                      std::span<const VelocityBlock> after, std::span<const BlockPlace> places,
                      RowWork& work) {
  map.spread(impulse, [&](int b, const Vector& given) {
    const VelocityBlock& block = after[index(b)];
    if (is_free(block, places[index(b)])) return;
    const Vector reaction = reaction_of(block, places[index(b)], given);
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

}  // namespace

RowWork account_work(ConstraintRows& rows, std::span<const Vector> before,
                     std::span<const VelocityBlock> after, std::span<const BlockPlace> places,
                     std::span<ImpulseOnWall> walls) {
  RowWork work;
  for (ConstraintRow& row : rows.row) {
    if (row.impulse == 0) continue;
    const RowMap map(rows, row);
    const Vector was = map.velocity([&](int b) { return before[index(b)]; });
    const Vector is = map.velocity([&](int b) { return after[index(b)].velocity; });
    const double normal_before = row.impulse * dot(row.normal, was);
    const double normal_after = row.impulse * dot(row.normal, is);
    row.normal_work = 0.5 * (normal_before + normal_after);
    work.normal_before += normal_before;
    work.normal_after += normal_after;
    work.friction_before += dot(row.friction, was);
    work.friction_after += dot(row.friction, is);
    const Vector impulse = impulse_of(row);
    account_supports(map, impulse, before, after, places, work);
    if (row.wall < 0) continue;
    ImpulseOnWall& wall = walls[index(row.wall)];
    wall.impulse = wall.impulse - impulse;
    wall.moment = wall.moment - cross(row.point, impulse);
    wall.work += dot(impulse, row.wall_velocity);
  }
  return work;
}

void sum_reactions(const ConstraintRows& rows, std::span<const VelocityBlock> after,
                   std::span<const BlockPlace> places, std::span<Vector> reaction) {
  for (const ConstraintRow& row : rows.row) {
    if (row.impulse == 0) continue;
    RowMap(rows, row).spread(impulse_of(row), [&](int b, const Vector& given) {
      const VelocityBlock& block = after[index(b)];
      if (!is_free(block, places[index(b)]))
        reaction[index(b)] = reaction[index(b)] + reaction_of(block, places[index(b)], given);
    });
  }
}

}  // namespace brio
