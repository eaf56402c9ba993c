#include "src/sweep/schedule.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "src/base/index.hpp"

namespace brio {

namespace {

constexpr std::size_t chunks_per_block = 32;      // whatever the number of threads
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
  std::array<double, 3> lower, upper;
  int longest() const {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (upper[index(i)] - lower[index(i)] > upper[index(axis)] - lower[index(axis)]) axis = i;
    return axis;
  }
};

CoordinateRange range_of(const std::vector<std::array<double, 3>>& points) {
  CoordinateRange extent{points.front(), points.front()};
  for (const auto& p : points)
    for (std::size_t i = 0; i < 3; ++i) {
      extent.lower[i] = std::min(extent.lower[i], p[i]);
      extent.upper[i] = std::max(extent.upper[i], p[i]);
    }
  return extent;
}

std::uint64_t morton_code(const std::array<double, 3>& point, const CoordinateRange& extent) {
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) size = std::max(size, extent.upper[i] - extent.lower[i]);
  std::uint64_t code = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double unit = size > 0 ? (point[i] - extent.lower[i]) / size : 0;
    code |= spread_bits(static_cast<std::uint64_t>(unit * 0x1fffff)) << i;
  }
  return code;
}

}  // namespace

std::vector<int> locality_order(std::span<const std::array<double, 3>> position,
                                std::span<const int> connectivity, int nodes_per_element) {
  const auto corners = index(nodes_per_element);
  const std::size_t count = connectivity.size() / corners;
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  if (count == 0) return order;

  std::vector<std::array<double, 3>> centre(count, {0, 0, 0});
  for (std::size_t e = 0; e < count; ++e)
    for (std::size_t corner = 0; corner < corners; ++corner)
      for (std::size_t i = 0; i < 3; ++i)
        centre[e][i] += position[index(connectivity[e * corners + corner])][i] / nodes_per_element;
  const CoordinateRange extent = range_of(centre);
  const auto axis = index(extent.longest());
  // Round-off in the centres must not scatter a layer of equal coordinates: compare on a grid.
  const double grid = (extent.upper[axis] - extent.lower[axis]) * 1e-9;
  const auto layer = [&](int e) {
    return grid > 0 ? std::llround((centre[index(e)][axis] - extent.lower[axis]) / grid) : 0LL;
  };
  std::vector<std::uint64_t> code(count);
  for (std::size_t e = 0; e < count; ++e) code[e] = morton_code(centre[e], extent);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return layer(a) < layer(b); });
  const std::size_t chunks = chunk_count(count);
  for (std::size_t c = 0; c < chunks; ++c)
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(count * c / chunks),
                     order.begin() + static_cast<std::ptrdiff_t>(count * (c + 1) / chunks),
                     [&](int a, int b) { return code[index(a)] < code[index(b)]; });
  return order;
}

SweepSchedule make_schedule(std::span<const Block> blocks, std::size_t node_count) {
  std::vector<SweepTask> tasks;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::size_t chunks = std::min(chunk_count(blocks[b].element_count), blocks[b].pack_count);
    const auto width = index(blocks[b].lanes);
    for (std::size_t c = 0; c < chunks; ++c) {
      const std::size_t first = blocks[b].pack_count * c / chunks;
      const std::size_t last = blocks[b].pack_count * (c + 1) / chunks;
      tasks.push_back({b, {first, last, std::min(last * width, blocks[b].element_count) - first * width}});
    }
  }
  // Greedy: the first colour that no node of the chunk has seen. A 64-bit set of colours a node is ample for
  // slabs; what finds none free gets a colour of its own.
  std::vector<std::uint64_t> used(node_count, 0);
  std::vector<std::size_t> colour(tasks.size());
  std::size_t colours = 0;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    const Block& block = blocks[tasks[t].block];
    const auto entries = index(nodes_per_element(block.element)) * index(block.lanes);
    const std::span<const int> nodes(block.connectivity.data() + tasks[t].chunk.first_pack * entries,
                                     (tasks[t].chunk.last_pack - tasks[t].chunk.first_pack) * entries);
    std::uint64_t taken = 0;
    for (int node : nodes) taken |= used[index(node)];
    const auto free = index(std::countr_one(taken));
    if (free < 64) {
      colour[t] = free;
      for (int node : nodes) used[index(node)] |= std::uint64_t{1} << free;
    } else {
      colour[t] = std::max<std::size_t>(colours, 64);
    }
    colours = std::max(colours, colour[t] + 1);
  }
  SweepSchedule schedule;
  for (std::size_t c = 0; c < colours; ++c) {
    schedule.colour_first.push_back(schedule.tasks.size());
    for (std::size_t t = 0; t < tasks.size(); ++t)
      if (colour[t] == c) schedule.tasks.push_back(tasks[t]);
  }
  schedule.colour_first.push_back(schedule.tasks.size());
  return schedule;
}

}  // namespace brio
