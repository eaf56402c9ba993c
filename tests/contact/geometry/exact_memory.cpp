// Memory of GMP's numbers, kept for the next of their size. What judges is not under test: under the address
// sanitizer the watch over each of its numbers took two thirds of the time of tests by exact arithmetic.

#include <gmp.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace brio::test {
namespace {

constexpr std::size_t unit = 16, kept_sizes = 64, pieces_of_slab = 64;

struct Piece {
  Piece* next;
};
// Slabs are never given back; the chain of all of them shows that none is lost.
struct alignas(unit) Slab {
  Slab* next;
};
std::atomic<Slab*> slabs{nullptr};
thread_local std::array<Piece*, kept_sizes> free_pieces{};

std::size_t units_of(std::size_t size) { return size == 0 ? 1 : (size + unit - 1) / unit; }

void* from_system(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void cut_slab(std::size_t units) {
  const std::size_t size = units * unit;
  auto* slab = static_cast<Slab*>(from_system(sizeof(Slab) + pieces_of_slab * size));
  slab->next = slabs.load();
  while (!slabs.compare_exchange_weak(slab->next, slab)) {
  }
  char* place = reinterpret_cast<char*>(slab + 1);
  for (std::size_t i = 0; i < pieces_of_slab; ++i, place += size)
    free_pieces[units] = new (place) Piece{free_pieces[units]};
}

void* take_number(std::size_t size) {
  const std::size_t units = units_of(size);
  if (units >= kept_sizes) return from_system(size);
  if (free_pieces[units] == nullptr) cut_slab(units);
  Piece* piece = free_pieces[units];
  free_pieces[units] = piece->next;
  return piece;
}

void keep_number(void* memory, std::size_t size) {
  const std::size_t units = units_of(size);
  if (units >= kept_sizes) return std::free(memory);
  free_pieces[units] = new (memory) Piece{free_pieces[units]};
}

void* resize_number(void* memory, std::size_t old_size, std::size_t size) {
  if (units_of(old_size) == units_of(size) && units_of(size) < kept_sizes) return memory;
  void* other = take_number(size);
  std::memcpy(other, memory, old_size < size ? old_size : size);
  keep_number(memory, old_size);
  return other;
}

[[maybe_unused]] const bool is_used = [] {
  mp_set_memory_functions(take_number, resize_number, keep_number);
  return true;
}();

}  // namespace
}  // namespace brio::test
