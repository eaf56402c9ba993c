#include "src/domains/schedule.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t chunks_per_block = 32;  // whatever the number of threads
constexpr std::size_t domains_per_block = 8;
constexpr std::size_t least_chunk_elements = 64;  // below this the hand-over costs more than the work

std::size_t chunk_count(std::size_t elements) {
  return std::clamp<std::size_t>(elements / least_chunk_elements, 1, chunks_per_block);
}

// Spreads the low 21 bits of a number so that two zeros stand between them.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

struct CoordinateRange {
  Vector3d lower, upper;
  int longest() const {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (upper[index(i)] - lower[index(i)] > upper[index(axis)] - lower[index(axis)]) axis = i;
    return axis;
  }
};

CoordinateRange range_of(const std::vector<Vector3d>& points) {
  CoordinateRange extent{points.front(), points.front()};
  for (const auto& p : points)
    for (std::size_t i = 0; i < 3; ++i) {
      extent.lower[i] = std::min(extent.lower[i], p[i]);
      extent.upper[i] = std::max(extent.upper[i], p[i]);
    }
  return extent;
}

std::uint64_t morton_code(const Vector3d& point, const CoordinateRange& extent) {
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) size = std::max(size, extent.upper[i] - extent.lower[i]);
  std::uint64_t code = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double unit = size > 0 ? (point[i] - extent.lower[i]) / size : 0;
    code |= spread_bits(static_cast<std::uint64_t>(unit * 0x1fffff)) << i;
  }
  return code;
}

// What follows from elements beside them: their domain is swept as one.
bool is_whole(const Block& block) { return block.cloud.has_value(); }

// Powers of two: then every domain has as many chunks, and threads that share those of a colour as much to
// do.
std::size_t domain_count(const Block& block, std::size_t chunks, std::size_t least_elements) {
  if (is_whole(block)) return 1;
  const std::size_t most = std::min(chunks, domains_per_block);
  return std::bit_floor(std::clamp<std::size_t>(block.element_count / least_elements, 1, most));
}

// A large block is several domains, in slabs like its chunks; small ones share a domain.
std::vector<DomainPiece> cut_domains(std::span<const Block> blocks, std::size_t least_elements) {
  std::vector<DomainPiece> pieces;
  std::size_t domain = 0;
  std::size_t gathered = 0;  // elements of the present domain
  const auto close = [&] {
    if (gathered > 0) ++domain;
    gathered = 0;
  };
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Block& block = blocks[b];
    if (block.element_count == 0) continue;
    const std::size_t chunks = std::min(chunk_count(block.element_count), block.pack_count);
    const std::size_t domains = domain_count(block, chunks, least_elements);
    if (domains > 1 || gathered >= least_elements || is_whole(block)) close();
    for (std::size_t d = 0; d < domains; ++d) {
      const std::size_t first_chunk = chunks * d / domains, last_chunk = chunks * (d + 1) / domains;
      const std::size_t first = block.pack_count * first_chunk / chunks;
      const std::size_t last = block.pack_count * last_chunk / chunks;
      const std::size_t elements =
          std::min(last * index(block.lanes), block.element_count) - first * index(block.lanes);
      pieces.push_back({domain, b, first, last, elements, last_chunk - first_chunk});
      gathered += elements;
      if (domains > 1) close();
    }
    if (is_whole(block)) close();
  }
  return pieces;
}

std::span<const int> nodes_of_packs(const Block& block, std::size_t first, std::size_t last) {
  const auto entries = index(nodes_per_element(block.element)) * index(block.lanes);
  return {block.connectivity.data() + first * entries, (last - first) * entries};
}

std::span<const int> nodes_of_piece(const DomainPiece& piece, std::span<const Block> blocks) {
  return nodes_of_packs(blocks[piece.block], piece.first_pack, piece.last_pack);
}

// Greedy: the first colour that no node has seen. A 64-bit set of colours a node is ample for slabs; what
// finds none free gets a colour of its own.
std::size_t free_colour(std::uint64_t taken, std::size_t colours) {
  const auto free = index(std::countr_one(taken));
  return free < 64 ? free : std::max<std::size_t>(colours, 64);
}

std::uint64_t bit_of(std::size_t colour) { return colour < 64 ? std::uint64_t{1} << colour : 0; }

void sort_by_stage(const std::vector<std::vector<int>>& nodes_of_domain, std::span<const Block> blocks,
                   std::size_t node_count, SweepSchedule& schedule) {
  std::vector<std::uint64_t> used(node_count, 0);
  std::vector<std::size_t> stage;
  std::size_t stages = 0;
  for (const std::vector<int>& nodes : nodes_of_domain) {
    std::uint64_t taken = 0;
    for (const int node : nodes) taken |= used[index(node)];
    stage.push_back(free_colour(taken, stages));
    for (const int node : nodes) used[index(node)] |= bit_of(stage.back());
    stages = std::max(stages, stage.back() + 1);
  }
  for (std::size_t s = 0; s < stages; ++s) {
    schedule.stage_domain_first.push_back(schedule.domain_of_stage.size());
    for (std::size_t d = 0; d < stage.size(); ++d)
      if (stage[d] == s) schedule.domain_of_stage.push_back(d);
  }
  schedule.stage_domain_first.push_back(schedule.domain_of_stage.size());
  const bool turning =
      std::ranges::any_of(blocks, [](const Block& block) { return has_rotations(block.element); });
  schedule.sums = make_domain_sums(nodes_of_domain, schedule.domain_of_stage, turning);
}

std::vector<SweepTask> tasks_of(std::span<const DomainPiece> pieces, std::span<const Block> blocks) {
  std::vector<SweepTask> tasks;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const DomainPiece& piece = pieces[p];
    const auto width = index(blocks[piece.block].lanes);
    const std::size_t packs = (piece.element_count + width - 1) / width;
    if (packs == 0) continue;
    const std::size_t chunks = std::min(
        std::clamp<std::size_t>(piece.element_count / least_chunk_elements, 1, piece.most_chunks), packs);
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::size_t first = packs * c / chunks, last = packs * (c + 1) / chunks;
      const std::size_t elements = std::min(last * width, piece.element_count) - first * width;
      tasks.push_back({piece.block, {piece.first_pack + first, piece.first_pack + last, elements}, p});
    }
  }
  return tasks;
}

std::vector<std::size_t> colours_within_domains(std::span<const SweepTask> tasks,
                                                std::span<const DomainPiece> pieces,
                                                std::span<const Block> blocks, std::size_t node_count) {
  struct Seen {
    std::size_t domain = ~std::size_t{0};
    std::uint64_t colours = 0;
  };
  std::vector<Seen> seen(node_count);
  std::vector<std::size_t> colour;
  std::size_t colours = 0;
  for (const SweepTask& task : tasks) {
    const std::size_t domain = pieces[task.piece].domain;
    const auto nodes = nodes_of_packs(blocks[task.block], task.chunk.first_pack, task.chunk.last_pack);
    std::uint64_t taken = 0;
    for (const int node : nodes)
      if (seen[index(node)].domain == domain) taken |= seen[index(node)].colours;
    colour.push_back(free_colour(taken, colours));
    for (const int node : nodes) {
      Seen& of_node = seen[index(node)];
      if (of_node.domain != domain) of_node = {domain, 0};
      of_node.colours |= bit_of(colour.back());
    }
    colours = std::max(colours, colour.back() + 1);
  }
  return colour;
}

// Stable; the key of each item is computed once.
template <class Key>
void sort_by_key(std::span<int> items, const Key& key) {
  struct Entry {
    std::uint64_t key;
    std::uint32_t place;
    int item;
  };
  std::vector<Entry> entries;
  entries.reserve(items.size());
  for (const int item : items)
    entries.push_back({key(item), static_cast<std::uint32_t>(entries.size()), item});
  std::ranges::sort(entries, {}, [](const Entry& entry) { return std::pair(entry.key, entry.place); });
  std::ranges::transform(entries, items.begin(), &Entry::item);
}

}  // namespace

std::vector<int> locality_order(std::span<const Vector3d> position, std::span<const int> connectivity,
                                int nodes_per_element) {
  const auto corners = index(nodes_per_element);
  const std::size_t count = connectivity.size() / corners;
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  if (count == 0) return order;

  std::vector<Vector3d> centre(count, {0, 0, 0});
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t corner = 0; corner < corners; ++corner)
      for (std::size_t i = 0; i < 3; ++i)
        centre[e][i] += position[index(connectivity[e * corners + corner])][i] / nodes_per_element;
  const CoordinateRange extent = range_of(centre);
  const auto axis = index(extent.longest());
  // Round-off in the centres must not scatter a layer of equal coordinates: compare on a grid.
  const double grid = (extent.upper[axis] - extent.lower[axis]) * 1e-9;
  const auto layer = [&](int e) -> std::uint64_t {
    return grid > 0 ? static_cast<std::uint64_t>(
                          std::llround((centre[index(e)][axis] - extent.lower[axis]) / grid))
                    : 0;
  };
  sort_by_key(order, layer);
  const std::size_t chunks = chunk_count(count);
  for (std::size_t c = 0; c < chunks; ++c) {
    const std::size_t first = count * c / chunks, last = count * (c + 1) / chunks;
    sort_by_key(std::span(order).subspan(first, last - first),
                [&](int e) { return morton_code(centre[index(e)], extent); });
  }
  return order;
}

std::vector<std::vector<int>> nodes_of_domains(std::span<const DomainPiece> pieces,
                                               std::span<const Block> blocks) {
  std::vector<std::vector<int>> nodes(pieces.empty() ? 0 : pieces.back().domain + 1);
  std::vector<char> is_seen;  // from the least node of the domain on
  for (std::size_t p = 0; p < pieces.size();) {
    const std::size_t domain = pieces[p].domain;
    std::size_t end = p;
    int least = std::numeric_limits<int>::max(), largest = 0;
    for (; end < pieces.size() && pieces[end].domain == domain; ++end)
      for (const int node : nodes_of_piece(pieces[end], blocks)) {
        least = std::min(least, node);
        largest = std::max(largest, node);
      }
    is_seen.assign(index(largest - least) + 1, 0);
    for (; p < end; ++p)
      for (const int node : nodes_of_piece(pieces[p], blocks)) is_seen[index(node - least)] = 1;
    for (std::size_t i = 0; i < is_seen.size(); ++i)
      if (is_seen[i] != 0) nodes[domain].push_back(least + static_cast<int>(i));
  }
  return nodes;
}

SweepSchedule make_schedule(std::span<const Block> blocks, std::size_t node_count,
                            std::size_t least_elements) {
  SweepSchedule schedule;
  schedule.pieces = cut_domains(blocks, least_elements);
  sort_by_stage(nodes_of_domains(schedule.pieces, blocks), blocks, node_count, schedule);
  cut_chunks(schedule, blocks, node_count);
  return schedule;
}

void cut_chunks(SweepSchedule& schedule, std::span<const Block> blocks, std::size_t node_count) {
  const std::vector<SweepTask> tasks = tasks_of(schedule.pieces, blocks);
  const std::vector<std::size_t> colour = colours_within_domains(tasks, schedule.pieces, blocks, node_count);
  const std::size_t colours = tasks.empty() ? 0 : *std::ranges::max_element(colour) + 1;
  std::vector<std::size_t> stage(schedule.domain_count());
  for (std::size_t s = 0; s + 1 < schedule.stage_domain_first.size(); ++s)
    for (std::size_t d = schedule.stage_domain_first[s]; d < schedule.stage_domain_first[s + 1]; ++d)
      stage[schedule.domain_of_stage[d]] = s;
  schedule.tasks.clear();
  schedule.colour_first.clear();
  schedule.stage_first.clear();
  for (std::size_t s = 0; s + 1 < schedule.stage_domain_first.size(); ++s) {
    schedule.stage_first.push_back(schedule.colour_first.size());
    for (std::size_t c = 0; c < colours; ++c) {
      const std::size_t first = schedule.tasks.size();
      for (std::size_t t = 0; t < tasks.size(); ++t)
        if (colour[t] == c && stage[schedule.pieces[tasks[t].piece].domain] == s)
          schedule.tasks.push_back(tasks[t]);
      if (schedule.tasks.size() > first) schedule.colour_first.push_back(first);
    }
  }
  schedule.stage_first.push_back(schedule.colour_first.size());
  schedule.colour_first.push_back(schedule.tasks.size());
}

}  // namespace brio
