#pragma once
/// Numbers of a report in 16 bits.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace brio {

/// Range of values that are quantized alike; empty until it has grown.
struct QuantizedRange {
  double min = 0, max = 0;
  bool empty = true;

  /// By all values that are finite.
  void grow(std::span<const double> values);
  double extent() const { return max - min; }
};

/// Code of what has no value: cells that are gone, and what is not finite.
inline constexpr std::uint16_t no_value = 65535;
inline constexpr double quantized_steps = 65534;

/// Nearest of the values min + i (max - min) / 65534, at most half of that step away. \pre value in the
/// range, or not finite
std::uint16_t quantized(double value, const QuantizedRange& range);
/// The value that a code stands for. \pre code is not `no_value`
double restored(std::uint16_t code, const QuantizedRange& range);

/// Bytes of numbers, little endian, in base64 (RFC 4648).
std::string base64(std::span<const unsigned char> bytes);

/// Numbers one after another, little endian whatever the processor.
class ByteTable {
 public:
  void add(std::uint8_t value) { bytes_.push_back(value); }
  void add(std::uint16_t value) { add_bytes(value, 2); }
  void add(std::uint32_t value) { add_bytes(value, 4); }
  void add(float value);
  std::span<const unsigned char> bytes() const { return bytes_; }

 private:
  void add_bytes(std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes_.push_back(static_cast<unsigned char>(value >> (8 * i)));
  }
  std::vector<unsigned char> bytes_;
};

}  // namespace brio
