#include "lowlap/matching/internal/pair_selection.h"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>

#include "support/matchers.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::IsError;
using testing::IsOk;

Scene SceneWith(const std::map<ViewId, std::string>& names) {
  Scene scene;
  for (const auto& [id, name] : names) scene.views[id].filename = name;
  return scene;
}

// Ids with a hole, as scene files may have them.
Scene FourViews() {
  return SceneWith({{0, "a.jpg"}, {2, "b.jpg"}, {3, "my photo.jpg"}, {7, "2"}});
}

TEST(SelectViewPairsTest, All) {
  const auto pairs = SelectViewPairs(FourViews(), "all");
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs,
              ElementsAre(ViewPair{0, 2}, ViewPair{0, 3}, ViewPair{0, 7},
                          ViewPair{2, 3}, ViewPair{2, 7}, ViewPair{3, 7}));
}

TEST(SelectViewPairsTest, ChainAndCycle) {
  const auto chain = SelectViewPairs(FourViews(), "chain");
  ASSERT_THAT(chain, IsOk());
  EXPECT_THAT(*chain,
              ElementsAre(ViewPair{0, 2}, ViewPair{2, 3}, ViewPair{3, 7}));
  const auto cycle = SelectViewPairs(FourViews(), "cycle");
  ASSERT_THAT(cycle, IsOk());
  EXPECT_THAT(*cycle, ElementsAre(ViewPair{0, 2}, ViewPair{0, 7},
                                  ViewPair{2, 3}, ViewPair{3, 7}));
}

TEST(SelectViewPairsTest, ACycleOfTwoViewsIsOnePair) {
  const auto pairs = SelectViewPairs(SceneWith({{1, "a"}, {5, "b"}}), "cycle");
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs, ElementsAre(ViewPair{1, 5}));
}

TEST(SelectViewPairsTest, FewerThanTwoViewsHaveNoPairs) {
  for (const char* specification : {"all", "chain", "cycle", "window:3"}) {
    for (const Scene& scene : {Scene{}, SceneWith({{4, "a"}})}) {
      const auto pairs = SelectViewPairs(scene, specification);
      ASSERT_THAT(pairs, IsOk());
      EXPECT_THAT(*pairs, IsEmpty());
    }
  }
}

TEST(SelectViewPairsTest, Window) {
  const auto two = SelectViewPairs(FourViews(), "window:2");
  ASSERT_THAT(two, IsOk());
  EXPECT_THAT(*two, ElementsAre(ViewPair{0, 2}, ViewPair{0, 3}, ViewPair{2, 3},
                                ViewPair{2, 7}, ViewPair{3, 7}));
  EXPECT_EQ(*SelectViewPairs(FourViews(), "window:99"),
            *SelectViewPairs(FourViews(), "all"));
}

TEST(SelectViewPairsTest, RejectsBadWindows) {
  for (const char* specification :
       {"window:", "window:0", "window:-1", "window:2x", "window:1.5",
        "window:99999999999"}) {
    EXPECT_THAT(SelectViewPairs(FourViews(), specification),
                IsError(ErrorCode::kInvalidArgument, specification));
  }
}

TEST(SelectViewPairsTest, ReadsAFile) {
  const std::string path = ::testing::TempDir() + "/lowlap_pairs.txt";
  std::ofstream(path) << "0 3\na.jpg b.jpg\n";
  const auto pairs = SelectViewPairs(FourViews(), path);
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs, ElementsAre(ViewPair{0, 2}, ViewPair{0, 3}));
  std::remove(path.c_str());
  EXPECT_THAT(SelectViewPairs(FourViews(), path),
              IsError(ErrorCode::kNotFound, "all, chain, cycle, window:N"));
  EXPECT_THAT(SelectViewPairs(FourViews(), "auto"),
              IsError(ErrorCode::kInvalidArgument, "features"));
}

TEST(ParsePairsTest, IdsNamesQuotesCommentsAndOrder) {
  const auto pairs = ParsePairs(FourViews(),
                                "# pairs to \"match\n"
                                " \t\n"
                                "  3 0 \r\n"
                                "\"my photo.jpg\"\tb.jpg\n"
                                "0 3\n"
                                "a.jpg 7",
                                "pairs.txt");
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs,
              ElementsAre(ViewPair{0, 3}, ViewPair{0, 7}, ViewPair{2, 3}));
}

TEST(ParsePairsTest, ANameThatIsANumberIsReadAsTheName) {
  const auto pairs = ParsePairs(FourViews(), "0 2\n", "pairs.txt");
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs, ElementsAre(ViewPair{0, 7}));
}

TEST(ParsePairsTest, StemsAreNamesWhateverTheIds) {
  const Scene scene =
      SceneWith({{0, "0001.jpg"}, {1, "0002.jpg"}, {2, "0003.jpg"}});
  const auto pairs = ParsePairs(scene, "0001 0002\n", "pairs.txt");
  ASSERT_THAT(pairs, IsOk());
  EXPECT_THAT(*pairs, ElementsAre(ViewPair{0, 1}));
}

TEST(ParsePairsTest, ErrorsNameTheLine) {
  const auto parse = [](const std::string& line) {
    return ParsePairs(FourViews(), "0 3\n\n" + line + "\n", "pairs.txt");
  };
  EXPECT_THAT(parse("0"), IsError(ErrorCode::kParse,
                                  "pairs.txt: line 3: expected two views"));
  EXPECT_THAT(parse("0 3 7"), IsError(ErrorCode::kParse, "line 3"));
  EXPECT_THAT(parse("0 9"), IsError(ErrorCode::kParse, "\"9\""));
  EXPECT_THAT(parse("0 c.jpg"), IsError(ErrorCode::kParse, "\"c.jpg\""));
  EXPECT_THAT(parse("0 -3"), IsError(ErrorCode::kParse, "\"-3\""));
  EXPECT_THAT(parse("3 3"), IsError(ErrorCode::kParse, "itself"));
  EXPECT_THAT(parse("0 \"my photo.jpg"), IsError(ErrorCode::kParse, "quote"));
  EXPECT_THAT(parse("\"\" 3"), IsError(ErrorCode::kParse, "no view"));
}

TEST(ParsePairsTest, TextWithoutAPairIsAnErrorOfTheFile) {
  for (const char* text : {"", "\n \n", "# 0 1\n"}) {
    const auto pairs = ParsePairs(FourViews(), text, "pairs.txt");
    ASSERT_THAT(pairs, IsError(ErrorCode::kParse, "names no pair of views"));
    EXPECT_EQ(pairs.error().file, "pairs.txt");
  }
}

TEST(ParsePairsTest, AnAmbiguousNameIsAnError) {
  const Scene scene = SceneWith({{0, "a.jpg"}, {1, "a.jpg"}, {2, "b.jpg"}});
  EXPECT_THAT(ParsePairs(scene, "a.jpg b.jpg", "p"),
              IsError(ErrorCode::kParse, "several views"));
}

}  // namespace
}  // namespace lowlap
