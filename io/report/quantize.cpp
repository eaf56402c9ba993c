#include "io/report/quantize.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace brio {

void QuantizedRange::grow(std::span<const double> values) {
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    min = empty ? value : std::min(min, value);
    max = empty ? value : std::max(max, value);
    empty = false;
  }
}

std::uint16_t quantized(double value, const QuantizedRange& range) {
  if (!std::isfinite(value)) return no_value;
  if (!(range.extent() > 0)) return 0;
  const double place = std::clamp((value - range.min) / range.extent(), 0.0, 1.0);
  return static_cast<std::uint16_t>(std::lround(place * quantized_steps));
}

double restored(std::uint16_t code, const QuantizedRange& range) {
  return range.min + range.extent() * (code / quantized_steps);
}

void ByteTable::add(float value) { add_bytes(std::bit_cast<std::uint32_t>(value), 4); }

std::string base64(std::span<const unsigned char> bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text.push_back(k <= count ? letters[group >> (18 - 6 * k) & 63] : '=');
  }
  return text;
}

}  // namespace brio
