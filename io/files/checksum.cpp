#include "io/files/checksum.hpp"

#include <array>
#include <bit>
#include <cstring>

namespace brio {
namespace {

constexpr std::uint64_t prime1 = 0x9E3779B185EBCA87U;
constexpr std::uint64_t prime2 = 0xC2B2AE3D27D4EB4FU;
constexpr std::uint64_t prime3 = 0x165667B19E3779F9U;
constexpr std::uint64_t prime4 = 0x85EBCA77C2B2AE63U;
constexpr std::uint64_t prime5 = 0x27D4EB2F165667C5U;

template <class Word>
std::uint64_t word_at(const unsigned char* bytes) {
  static_assert(std::endian::native == std::endian::little);
  Word word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

std::uint64_t round(std::uint64_t sum, std::uint64_t word) {
  return std::rotl(sum + word * prime2, 31) * prime1;
}

/// Of the part that is made of stripes of 32 bytes, in four lanes.
std::uint64_t sum_of_stripes(const unsigned char* bytes, std::size_t stripes) {
  std::array<std::uint64_t, 4> lane{prime1 + prime2, prime2, 0, 0 - prime1};
  for (; stripes > 0; --stripes, bytes += 32)
    for (std::size_t i = 0; i < 4; ++i) lane[i] = round(lane[i], word_at<std::uint64_t>(bytes + 8 * i));
  std::uint64_t sum =
      std::rotl(lane[0], 1) + std::rotl(lane[1], 7) + std::rotl(lane[2], 12) + std::rotl(lane[3], 18);
  for (const std::uint64_t part : lane) sum = (sum ^ round(0, part)) * prime1 + prime4;
  return sum;
}

}  // namespace

std::uint64_t checksum(const void* data, std::size_t bytes) {
  const auto* at = static_cast<const unsigned char*>(data);
  const unsigned char* const end = at + bytes;
  std::uint64_t sum = bytes >= 32 ? sum_of_stripes(at, bytes / 32) : prime5;
  at += bytes / 32 * 32;
  sum += bytes;
  for (; end - at >= 8; at += 8)
    sum = std::rotl(sum ^ round(0, word_at<std::uint64_t>(at)), 27) * prime1 + prime4;
  if (end - at >= 4) {
    sum = std::rotl(sum ^ (word_at<std::uint32_t>(at) * prime1), 23) * prime2 + prime3;
    at += 4;
  }
  for (; at < end; ++at) sum = std::rotl(sum ^ (*at * prime5), 11) * prime1;
  sum = (sum ^ (sum >> 33)) * prime2;
  sum = (sum ^ (sum >> 29)) * prime3;
  return sum ^ (sum >> 32);
}

}  // namespace brio
