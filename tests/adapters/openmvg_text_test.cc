#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "adapters/openmvg_vectors.h"
#include "third_party_adapters/openmvg/internal/feat.h"
#include "third_party_adapters/openmvg/internal/matches.h"

namespace lowlap::openmvg {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The example of two pairs, as OpenMVG wrote it.
constexpr char kMatchesText[] = "0 1\n2\n3 4\n5 6\n0 2\n1\n7 8\n";
constexpr char kMatchesHex[] =
    "010200000000000000"
    "0000000001000000020000000000000003000000040000000500000006000000"
    "0000000002000000010000000000000007000000"
    "08000000";

PairMatches Example() {
  return {{{0, 1}, {{3, 4}, {5, 6}}}, {{0, 2}, {{7, 8}}}};
}

TEST(Feat, ReadsTwoFourAndEightNumbersALine) {
  for (const char* text : {"1.5 -2\n3 1e-07\n", "1.5 -2 1.5 0.1\n3 1e-07 2 3\n",
                           "1.5 -2 1 2 3 4 5 6\n3 1e-07 1 2 3 4 5 6\n"}) {
    const auto points = ParseFeat(text);
    ASSERT_TRUE(points.has_value()) << points.error().ToString();
    EXPECT_THAT(*points, ElementsAre(Vec2(1.5, -2), Vec2(3, 1e-7)));
  }
}

TEST(Feat, ReadsOtherLineEndsAndBlanks) {
  const auto points = ParseFeat("1 2 3 4\r\n  5\t6 7  8 \r\n\r\n9 10 1 1");
  ASSERT_TRUE(points.has_value()) << points.error().ToString();
  EXPECT_THAT(*points, ElementsAre(Vec2(1, 2), Vec2(5, 6), Vec2(9, 10)));
  EXPECT_TRUE(ParseFeat("")->empty());
}

TEST(Feat, MalformedLinesAreNamed) {
  const auto error = [](const char* text) {
    const auto points = ParseFeat(text, "0000.feat");
    EXPECT_FALSE(points.has_value()) << text;
    return points ? std::string() : points.error().ToString();
  };
  EXPECT_THAT(error("1 2 3 4\n1 x 3 4\n"), HasSubstr("line 2: 'x'"));
  EXPECT_THAT(error("1 2 3 4\n1 2 3\n"), HasSubstr("line 2"));
  EXPECT_THAT(error("1 2 3\n"), HasSubstr("2, 4 or 8"));
  EXPECT_THAT(error("1 nan 3 4\n"), HasSubstr("'nan'"));
  EXPECT_THAT(error("1 1e999 3 4\n"), HasSubstr("'1e999'"));
  EXPECT_THAT(error("1 2;3 4 5\n"), HasSubstr("'2;3'"));
}

TEST(Matches, ReadsTheExampleInBothForms) {
  EXPECT_EQ(*ParseMatchesText(kMatchesText), Example());
  EXPECT_EQ(*ParseMatchesBin(FromHex(kMatchesHex)), Example());
}

TEST(Matches, PairsAreTurnedAndTheLastOneCounts) {
  const auto matches = ParseMatchesText("0 1 1 9 9 \r\n 1 0\n2\n4 3\n6 5\n");
  ASSERT_TRUE(matches.has_value()) << matches.error().ToString();
  ASSERT_EQ(matches->size(), 1u);
  EXPECT_EQ(matches->at({0, 1}), Example().at({0, 1}));
}

TEST(Matches, EveryTruncationOfTheBinaryIsAnError) {
  const std::string bytes = FromHex(kMatchesHex);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(ParseMatchesBin(bytes.substr(0, size)).has_value()) << size;
  }
}

TEST(Matches, MalformedContentIsNamed) {
  const auto text_error = [](const char* text) {
    const auto matches = ParseMatchesText(text, "m.txt");
    EXPECT_FALSE(matches.has_value()) << text;
    return matches ? std::string() : matches.error().ToString();
  };
  EXPECT_THAT(text_error("0 1\n2\n3 4\n5\n"), HasSubstr("the file ends"));
  EXPECT_THAT(text_error("0 1\n2\n3 4\n-5 6\n"), HasSubstr("line 4"));
  EXPECT_THAT(text_error("0 x\n"), HasSubstr("'x'"));
  EXPECT_THAT(text_error("0"), HasSubstr("view id"));
  EXPECT_THAT(text_error("0 1\n"), HasSubstr("number of matches"));
  EXPECT_THAT(text_error("0 1\n99999999999\n"), HasSubstr("do not fit"));
  EXPECT_THAT(text_error("3 3\n0\n"), HasSubstr("with itself"));
  EXPECT_THAT(text_error("0 4294967296\n0\n"), HasSubstr("'4294967296'"));

  std::string bytes = FromHex(kMatchesHex);
  bytes[21] = '\x7F';  // the count of the first pair
  const auto damaged = ParseMatchesBin(bytes, "m.bin");
  ASSERT_FALSE(damaged.has_value());
  EXPECT_THAT(damaged.error().ToString(), HasSubstr("m.bin: byte 17"));
  const auto other = ReadMatches("matches.e.TXT");
  ASSERT_FALSE(other.has_value());
  EXPECT_EQ(other.error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace lowlap::openmvg
