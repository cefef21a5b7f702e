#include "lowlap/core/hash.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

std::string HexOf(std::string_view bytes) {
  Hash128 hash;
  hash.AddBytes(bytes);
  return ToHex(hash.value());
}

// The published test vectors of FNV-1a, 128 bits.
TEST(Hash128, PublishedValues) {
  EXPECT_EQ(HexOf(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(HexOf("a"), "d228cb696f1a8caf78912b704e4a8964");
  EXPECT_EQ(HexOf("foobar"), "343e1662793c64bf6f0d3597ba446f18");
}

TEST(Hash128, PartsDoNotRunTogether) {
  Hash128 one, other;
  one.Add("ab");
  one.Add("c");
  other.Add("a");
  other.Add("bc");
  EXPECT_NE(one.value(), other.value());
}

TEST(Hash128, NumbersAreTheirBits) {
  Hash128 zero, negative_zero;
  zero.Add(0.0);
  negative_zero.Add(-0.0);
  EXPECT_NE(zero.value(), negative_zero.value());
}

}  // namespace
}  // namespace lowlap
