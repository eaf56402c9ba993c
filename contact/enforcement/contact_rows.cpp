#include "contact/enforcement/contact_rows.hpp"

#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

namespace {

constexpr std::size_t contacts_a_piece = 128;
constexpr std::size_t blocks_a_range = 256;

/// What is known of a block from its owner.
class BlockFiller {
 public:
  BlockFiller(ContactRows& all, const RowSources& sources)
      : all_(all), nodes_(sources.nodes), bodies_(sources.bodies) {}

  void fill(std::size_t block) const {
    const auto of = index(all_.owner[block].index);
    switch (all_.owner[block].kind) {
      case BlockOwner::Kind::node:
        return fill_node(block, of);
      case BlockOwner::Kind::rotation_of_node:
        return fill_rotation(block, of);
      case BlockOwner::Kind::body:
        return fill_body(block, bodies_[of]);
      case BlockOwner::Kind::rotation_of_body:
        return fill_rotation_of_body(block, of);
    }
  }

 private:
  void set(std::size_t block, const VelocityBlock& velocity, const Vector3d& before,
           const BlockPlace& place) const {
    all_.block[block] = velocity;
    all_.before[block] = before;
    all_.place[block] = place;
  }
  void fill_node(std::size_t block, std::size_t n) const {
    const bool skew = nodes_.own_axes(n) != nullptr && nodes_.prescribed_translations(n) != 0;
    const double norm = skew && nodes_.prescribed_translations(n) != 7 ? nodes_.record[n].inverse_mass : 0;
    set(block, {vector_at(nodes_.record[n].velocity), nodes_.free_inverse_mass(n), norm},
        vector_at(nodes_.velocity_before[n].component),
        {.position = vector_at(nodes_.record[n].position), .skew = skew, .mass = skew ? nodes_.mass[n] : 0});
  }
  void fill_rotation(std::size_t block, std::size_t n) const {
    const double* rate = nodes_.angular_velocity[n].component;
    const bool skew = nodes_.own_axes(n) != nullptr && nodes_.prescribed_rotations(n) != 0;
    const double norm = skew && nodes_.prescribed_rotations(n) != 7 ? rate[3] : 0;
    set(block, {vector_at(rate), nodes_.free_inverse_inertia(n), norm},
        vector_at(nodes_.angular_velocity_before[n].component),
        {.turns = true, .skew = skew, .mass = skew ? nodes_.rotational_inertia[n] : 0});
  }
  void fill_body(std::size_t block, const RigidMotion& motion) const {
    const bool skew = motion.has_own_axes();
    set(block,
        {motion.velocity, symmetric_part(motion.free_inverse_mass()), largest_component(motion.inverse_mass)},
        motion.velocity_before, {.position = motion.centre, .skew = skew, .mass = skew ? motion.mass : 0});
  }
  void fill_rotation_of_body(std::size_t block, std::size_t body) const {
    const RigidMotion& motion = bodies_[body];
    all_.body_inertia[body] = symmetric_part(motion.inertia);
    set(block, {motion.angular_velocity, symmetric_part(motion.inverse_inertia)},
        motion.angular_velocity_before,
        {.turns = true, .inertia = &all_.body_inertia[body], .skew = motion.has_own_axes()});
  }

  ContactRows& all_;
  const Nodes& nodes_;
  std::span<const RigidMotion> bodies_;
};

// New unknowns become blocks, in the order of pieces.
void number_blocks(ContactRows& rows, const Unknowns& unknowns, std::size_t pieces) {
  const auto number = [&](auto& entries) {
    for (auto& entry : entries) {
      int& block = rows.block_of[index(entry.block)];
      if (block < 0) {
        block = static_cast<int>(rows.owner.size());
        rows.owner.push_back(unknowns.owner(entry.block));
        rows.unknown.push_back(entry.block);
      }
      entry.block = block;
    }
  };
  for (std::size_t p = 0; p < pieces; ++p) {
    ConstraintRows& own = rows.piece[p].rows;
    number(own.translation);
    number(own.rotation);
    number(own.matrix);
  }
}

void fill_new_blocks(ContactRows& rows, const RowSources& sources, ThreadTeam& team) {
  const std::size_t known = rows.block.size(), added = rows.owner.size() - known;
  rows.block.resize(rows.owner.size());
  rows.before.resize(rows.owner.size());
  rows.place.resize(rows.owner.size());
  const BlockFiller filler(rows, sources);
  team.for_ranges(added, blocks_a_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) filler.fill(known + b);
  });
}

void append(ContactRows& rows, std::size_t pieces, ThreadTeam& team) {
  rows.piece_begin.clear();
  for (std::size_t p = 0; p < pieces; ++p) {
    rows.piece_begin.push_back(rows.end);
    rows.end += rows.piece[p].rows.counts();
  }
  rows.rows.resize(rows.end);
  team.for_each(pieces, [&](std::size_t p) { rows.rows.overwrite(rows.piece_begin[p], rows.piece[p].rows); });
}

/// \param build of a piece, from contacts [begin, end)
template <class Build>
void add_pieces(ContactRows& rows, const RowSources& sources, std::size_t contacts, ThreadTeam& team,
                const Build& build) {
  const Unknowns unknowns = unknowns_of(sources);
  rows.block_of.resize(unknowns.size(sources.nodes.has_rotations()), -1);
  rows.body_inertia.resize(sources.bodies.size());
  const std::size_t pieces = (contacts + contacts_a_piece - 1) / contacts_a_piece;
  if (rows.piece.size() < pieces) rows.piece.resize(pieces);
  team.for_ranges(contacts, contacts_a_piece, [&](std::size_t begin, std::size_t end) {
    build(rows.piece[begin / contacts_a_piece], begin, end);
  });
  number_blocks(rows, unknowns, pieces);
  fill_new_blocks(rows, sources, team);
  append(rows, pieces, team);
}

}  // namespace

void ContactRows::clear() {
  for (const int one : unknown) block_of[index(one)] = -1;
  end = {};
  unknown.clear();
  block.clear();
  owner.clear();
  before.clear();
  place.clear();
}

void add_rows(ContactRows& rows, const RowSources& sources, std::span<const Contact> contacts,
              ThreadTeam& team) {
  add_pieces(rows, sources, contacts.size(), team, [&](RowPiece& piece, std::size_t begin, std::size_t end) {
    build_rows(piece, sources, contacts.subspan(begin, end - begin));
  });
}

void add_rows(ContactRows& rows, const RowSources& sources, std::span<const ContactWall> walls,
              std::span<const NodeAtWall> touches, ThreadTeam& team) {
  add_pieces(rows, sources, touches.size(), team, [&](RowPiece& piece, std::size_t begin, std::size_t end) {
    build_rows(piece, sources, walls, touches.subspan(begin, end - begin));
  });
}

}  // namespace brio
