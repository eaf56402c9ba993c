#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/report/quantize.hpp"

namespace brio {
namespace {

TEST(ReportQuantize, ErrsByHalfAStepAtMost) {
  std::mt19937 random(3);
  for (const auto& [low, high] : {std::pair{0.0, 1.0}, {-3e9, 2e-3}, {1e300, 1.7e300}, {5e-9, 6e-9}}) {
    std::vector<double> values{low, high};
    std::uniform_real_distribution<double> any(low, high);
    for (int i = 0; i < 20000; ++i) values.push_back(any(random));
    QuantizedRange range;
    range.grow(values);
    EXPECT_EQ(range.min, low);
    EXPECT_EQ(range.max, high);
    const double half_a_step = 0.5 * (high - low) / 65534;
    for (const double value : values) {
      const std::uint16_t code = quantized(value, range);
      ASSERT_NE(code, no_value);
      ASSERT_LE(std::abs(restored(code, range) - value), half_a_step * (1 + 1e-9));
    }
    EXPECT_EQ(restored(quantized(low, range), range), low);
    EXPECT_NEAR(restored(quantized(high, range), range), high, 1e-15 * (high - low));
  }
}

TEST(ReportQuantize, MarksWhatIsNoNumber) {
  QuantizedRange range;
  range.grow(std::vector<double>{std::nan(""), 2, std::numeric_limits<double>::infinity(), -1});
  EXPECT_EQ(range.min, -1);
  EXPECT_EQ(range.max, 2);
  EXPECT_EQ(quantized(std::nan(""), range), no_value);
  EXPECT_EQ(quantized(std::numeric_limits<double>::infinity(), range), no_value);
}

TEST(ReportQuantize, KeepsAConstant) {
  QuantizedRange range;
  range.grow(std::vector<double>{7.25, 7.25});
  EXPECT_EQ(restored(quantized(7.25, range), range), 7.25);
}

TEST(ReportBase64, HasTheVectorsOfRfc4648) {
  const auto of = [](std::string_view text) {
    return base64({reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foob"), "Zm9vYg==");
  EXPECT_EQ(of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(ReportBytes, AreLittleEndian) {
  ByteTable table;
  table.add(std::uint8_t{1});
  table.add(std::uint16_t{0x0203});
  table.add(std::uint32_t{0x04050607});
  table.add(1.0F);
  const std::vector<unsigned char> bytes(table.bytes().begin(), table.bytes().end());
  EXPECT_EQ(bytes, (std::vector<unsigned char>{1, 3, 2, 7, 6, 5, 4, 0, 0, 0x80, 0x3f}));
}

}  // namespace
}  // namespace brio
