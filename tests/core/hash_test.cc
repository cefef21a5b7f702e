#include "lowlap/core/internal/hash.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

std::string HexOf(std::string_view bytes) {
  Hash128 hash;
  hash.AddBytes(bytes);
  return ToHex(hash.value());
}

// What `xxhsum -H2` prints.
TEST(Hash128, PublishedValues) {
  EXPECT_EQ(HexOf(""), "99aa06d3014798d86001c324468d497f");
  EXPECT_EQ(HexOf("a"), "a96faf705af16834e6c632b61e964e1f");
  EXPECT_EQ(HexOf("abc"), "06b05ab6733a618578af5f94892f3950");
}

TEST(Hash128, DoesNotDependOnThePieces) {
  std::string bytes;
  for (int n = 0; n < 5000; ++n) bytes += static_cast<char>(n * 7);
  Hash128 pieces;
  for (std::size_t at = 0; at < bytes.size(); at += 13) {
    pieces.AddBytes(std::string_view(bytes).substr(at, 13));
  }
  EXPECT_EQ(ToHex(pieces.value()), HexOf(bytes));
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
