#include "lowlap/core/internal/token_reader.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;

TEST(TokenReader, TakesNumbersOfAnyKindOverLines) {
  TokenReader reader("1 -2.5e3\r\n\t 18446744073709551615\n", "file");
  EXPECT_EQ(reader.Next<int>("a count"), 1);
  EXPECT_FALSE(reader.AtLineEnd());
  EXPECT_EQ(reader.Next<double>("a number"), -2500.0);
  EXPECT_TRUE(reader.AtLineEnd());
  EXPECT_FALSE(reader.AtEnd());
  EXPECT_EQ(reader.Next<std::uint64_t>("a seed"), UINT64_MAX);
  EXPECT_TRUE(reader.AtEnd());
  EXPECT_TRUE(reader.AtLineEnd());
  EXPECT_TRUE(reader.status());
}

TEST(TokenReader, TakesWordsAsTheyAre) {
  TokenReader reader("\n a.jpg\t12\n", "file");
  EXPECT_EQ(reader.Peek(), 'a');
  EXPECT_EQ(reader.Word("a name"), "a.jpg");
  EXPECT_EQ(reader.Next<int>("a count"), 12);
  EXPECT_EQ(reader.Word("a name"), "");
  EXPECT_THAT(reader.status(),
              IsError(ErrorCode::kParse, "the file ends where a name"));
}

TEST(TokenReader, TheFirstFailureStaysWithItsLine) {
  TokenReader reader("1\n2 x\nnan", "file");
  EXPECT_EQ(reader.Next<int>("a count"), 1);
  EXPECT_EQ(reader.Next<int>("a count"), 2);
  EXPECT_EQ(reader.Next<int>("a count"), 0);
  EXPECT_EQ(reader.Next<double>("a number"), 0);
  EXPECT_THAT(reader.status(),
              IsError(ErrorCode::kParse, "file: line 2: 'x' is not a count"));
}

TEST(TokenReader, WhatIsNoNumberOfItsKindIsRefused) {
  for (const char* text : {"-1", "1.5", "4294967296", "1x", "0x1", ""}) {
    TokenReader reader(text, "file");
    EXPECT_EQ(reader.Next<std::uint32_t>("an id"), 0u) << text;
    EXPECT_THAT(reader.status(), IsError(ErrorCode::kParse, "an id")) << text;
  }
  for (const char* text : {"nan", "inf", "1e999", "1,5", "1;"}) {
    TokenReader reader(text, "file");
    EXPECT_EQ(reader.Next<double>("a number"), 0) << text;
    EXPECT_THAT(reader.status(), IsError(ErrorCode::kParse, text)) << text;
  }
}

TEST(TokenReader, LinesHaveNoEndsAndNoOuterBlanks) {
  TokenReader reader(" a b \r\n\n c", "file");
  std::string_view line;
  ASSERT_TRUE(reader.NextLine(&line));
  EXPECT_EQ(line, "a b");
  ASSERT_TRUE(reader.NextLine(&line));
  EXPECT_EQ(line, "");
  ASSERT_TRUE(reader.NextLine(&line));
  EXPECT_EQ(line, "c");
  EXPECT_FALSE(reader.NextLine(&line));
}

}  // namespace
}  // namespace lowlap
