#include "src/sweep/erosion.hpp"

#include <algorithm>
#include <numeric>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Padding over all lanes, beyond which chunks are made anew.
constexpr double most_padding = 0.25;

std::size_t packs_for(std::size_t elements, const Block& block) {
  const auto width = index(block.lanes);
  return elements == 0 ? 0 : (elements + width - 1) / width;  // a rigid part's block has no lanes
}

void leave_nodes(Erosion& erosion, const Block& block, std::size_t place) {
  for (int corner = 0; corner < nodes_per_element(block.element); ++corner) {
    const int node = block.node(place, corner);
    if (--erosion.elements_of_node[index(node)] > 0) continue;
    erosion.freed.push_back(node);
    if (block.deletion.free_nodes == FreeNodes::drop) erosion.dropping.push_back(node);
  }
}

void account(const Block& block, std::size_t place, Contribution& sum) {
  const HeldEnergy held = held_energy(block, place);
  sum.internal -= held.internal;
  sum.hourglass -= held.hourglass;
  sum.deleted += held.internal + held.hourglass;
}

// The last element of the chunk takes the place.
void fill_place(Block& block, Chunk& chunk, std::size_t place, PartInModel& part) {
  const auto width = index(block.lanes);
  const std::size_t last = chunk.first_pack * width + --chunk.element_count;
  --block.element_count;
  part.element_slot[index(part.element_order[place])] = -1;
  if (place != last) {
    copy_element(block, last, place);
    part.element_order[place] = part.element_order[last];
    part.element_slot[index(part.element_order[place])] = static_cast<int>(place);
  }
  part.element_order[last] = -1;
}

// Padding lanes repeat an existing element, so that they contain valid numbers. \param end place after the
// last
void fill_padding(Block& block, std::size_t first, std::size_t end) {
  if (end == first) return;
  for (std::size_t place = end; place % index(block.lanes) != 0; ++place) copy_element(block, end - 1, place);
}

}  // namespace

std::int64_t Erosion::total_deleted() const {
  return std::accumulate(deleted_count.begin(), deleted_count.end(), std::int64_t{0});
}

bool can_erode(std::span<const Block> blocks) {
  return std::any_of(blocks.begin(), blocks.end(), [](const Block& block) { return block.loses_elements; });
}

Erosion make_erosion(std::span<const Block> blocks, std::size_t node_count) {
  Erosion erosion;
  erosion.elements_of_node.assign(node_count, 0);
  erosion.deleted_count.assign(blocks.size(), 0);
  std::size_t elements = 0;
  for (const Block& block : blocks) {
    if (block.loses_elements) elements += block.element_count;
    for (std::size_t e = 0; e < block.element_count; ++e)
      for (int corner = 0; corner < nodes_per_element(block.element); ++corner)
        ++erosion.elements_of_node[index(block.node(e, corner))];
  }
  erosion.deleted.reserve(elements);
  erosion.freed.reserve(node_count);
  erosion.dropping.reserve(node_count);
  return erosion;
}

Contribution erode(Erosion& erosion, SweepSchedule& schedule, std::span<const SweepResult> results,
                   std::span<Block> blocks, std::span<PartInModel> parts) {
  Contribution energies;
  erosion.deleted.clear();
  erosion.freed.clear();
  for (std::size_t t = 0; t < schedule.tasks.size(); ++t) {
    if (results[t].lost == 0) continue;
    for (std::size_t cause = 0; cause < results[t].lost_by.size(); ++cause)
      erosion.deleted_by_cause[cause] += results[t].lost_by[cause];
    SweepTask& task = schedule.tasks[t];
    schedule.pieces[task.piece].element_count -= results[t].lost;
    Block& block = blocks[task.block];
    PartInModel& part = parts[task.block];
    const int* lost = block.lost.data() + task.chunk.first_pack * index(block.lanes);
    // From the last on: what fills a place is never itself lost.
    for (std::size_t k = results[t].lost; k-- > 0;) {
      const auto place = index(lost[k]);
      erosion.deleted.push_back({static_cast<int>(task.block), part.element_order[place]});
      erosion.mass_of_deleted += block.kernel.mass(block, place);
      ++erosion.deleted_count[task.block];
      account(block, place, energies);
      leave_nodes(erosion, block, place);
      if (block.cloud) cut_particle(*block.cloud, block.node(place, 0) - block.cloud->first_node);
      fill_place(block, task.chunk, place, part);
    }
    const std::size_t first = task.chunk.first_pack * index(block.lanes);
    fill_padding(block, first, first + task.chunk.element_count);
  }
  std::sort(erosion.deleted.begin(), erosion.deleted.end());
  std::sort(erosion.freed.begin(), erosion.freed.end());
  std::sort(erosion.dropping.begin(), erosion.dropping.end());
  return energies;
}

bool is_sparse(const SweepSchedule& schedule, std::span<const Block> blocks) {
  std::size_t used = 0, needed = 0;
  for (const SweepTask& task : schedule.tasks)
    used += packs_for(task.chunk.element_count, blocks[task.block]);
  for (const DomainPiece& piece : schedule.pieces)
    needed += packs_for(piece.element_count, blocks[piece.block]);
  return static_cast<double>(used - needed) > most_padding * static_cast<double>(used);
}

void repack(SweepSchedule& schedule, std::span<Block> blocks, std::span<PartInModel> parts,
            std::size_t node_count) {
  std::vector<SweepTask> tasks = schedule.tasks;
  std::ranges::sort(tasks, {},
                    [](const SweepTask& task) { return std::pair(task.piece, task.chunk.first_pack); });
  std::vector<std::size_t> next;  // place of each piece
  for (const DomainPiece& piece : schedule.pieces)
    next.push_back(piece.first_pack * index(blocks[piece.block].lanes));
  for (const SweepTask& task : tasks) {
    Block& block = blocks[task.block];
    PartInModel& part = parts[task.block];
    const std::size_t first = task.chunk.first_pack * index(block.lanes);
    for (std::size_t from = first; from < first + task.chunk.element_count; ++from) {
      const std::size_t to = next[task.piece]++;
      if (from == to) continue;
      copy_element(block, from, to);
      const int element = part.element_order[from];
      part.element_order[to] = element;
      part.element_order[from] = -1;
      part.element_slot[index(element)] = static_cast<int>(to);
    }
  }
  for (std::size_t p = 0; p < schedule.pieces.size(); ++p) {
    const DomainPiece& piece = schedule.pieces[p];
    Block& block = blocks[piece.block];
    block.pack_count = piece.first_pack + packs_for(piece.element_count, block);
    if (block.loses_elements) fill_padding(block, piece.first_pack * index(block.lanes), next[p]);
  }
  cut_chunks(schedule, blocks, node_count);
}

void remove_sides(ActiveLoad& load, std::span<const DeletedElement> deleted) {
  auto* pressure = std::get_if<PressureLoad>(&load.load);
  if (pressure == nullptr) return;
  std::size_t kept = 0;
  for (std::size_t s = 0; s < pressure->sides.size(); ++s) {
    const DeletedElement owner{pressure->part, pressure->element[s]};
    if (std::binary_search(deleted.begin(), deleted.end(), owner)) continue;
    pressure->sides[kept] = pressure->sides[s];
    pressure->element[kept++] = pressure->element[s];
  }
  pressure->sides.resize(kept);
  pressure->element.resize(kept);
}

void remove_nodes(ActiveLoad& load, std::span<const int> dropping) {
  auto* nodal = std::get_if<NodalLoad>(&load.load);
  if (nodal == nullptr || dropping.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < nodal->nodes.size(); ++i) {
    if (std::binary_search(dropping.begin(), dropping.end(), nodal->nodes[i])) continue;
    if (!nodal->own_force.empty()) nodal->own_force[kept] = nodal->own_force[i];
    nodal->nodes[kept++] = nodal->nodes[i];
  }
  nodal->nodes.resize(kept);
  if (!nodal->own_force.empty()) nodal->own_force.resize(kept);
}

Contribution remove_nodes(Erosion& erosion, Nodes& nodes) {
  Contribution removed;
  for (const int entry : erosion.dropping) {
    const auto node = index(entry);
    NodeRecord& record = nodes.record[node];
    const double mass = nodes.mass[node];
    const Vector3d position = vector_at(record.position);
    const Vector3d velocity = vector_at(record.velocity);
    removed.deleted += 0.5 * mass * dot(velocity, velocity);
    removed.dropped.add(position, {mass * velocity[0], mass * velocity[1], mass * velocity[2]});
    erosion.dropped_mass += mass;
    nodes.mass[node] = record.inverse_mass = 0;
    for (double& component : record.velocity) component = 0;
    if (!nodes.has_rotations()) continue;
    double* spin = nodes.angular_velocity[node].component;
    const double inertia = nodes.rotational_inertia[node];
    removed.deleted += 0.5 * inertia * (spin[0] * spin[0] + spin[1] * spin[1] + spin[2] * spin[2]);
    for (std::size_t i = 0; i < 3; ++i) removed.dropped.angular[i] += inertia * spin[i];
    nodes.rotational_inertia[node] = 0;
    nodes.angular_velocity[node] = {};
  }
  erosion.dropping.clear();
  return removed;
}

MassBalance mass_balance(const Erosion& erosion, const Nodes& nodes) {
  MassBalance balance;
  for (std::size_t node = 0; node < nodes.size(); ++node)
    (erosion.elements_of_node[node] > 0 ? balance.intact : balance.debris) += nodes.mass[node];
  return balance;
}

}  // namespace brio
