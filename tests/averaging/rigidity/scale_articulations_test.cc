#include "lowlap/averaging/rigidity/internal/scale_articulations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "averaging/rigidity/scene_with_edges.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using ViewPairs = std::vector<ViewPair>;

ScaleRatio RatioOf(const ViewTriplet& views, double log10_nfa = -12) {
  ScaleRatio ratio;
  ratio.views = views;
  ratio.verdict = RatioVerdict::kMeaningful;
  ratio.log10_nfa = log10_nfa;
  ratio.log_ratio_stddev = 0.01;
  ratio.kinds = {{"points", 20, 20}};
  return ratio;
}

std::vector<ScaleArticulation> Find(const ViewPairs& edges,
                                    const std::vector<ScaleRatio>& ratios) {
  std::vector<ViewTriplet> triplets;
  for (const ScaleRatio& ratio : ratios) {
    if (ratio.verdict == RatioVerdict::kMeaningful) {
      triplets.push_back(ratio.views);
    }
  }
  const ViewGraph graph(edges);
  ScaleDiagnosis diagnosis;
  diagnosis.by_directions = AnalyzeRigidity(graph);
  diagnosis.by_ratios = AnalyzeRigidity(graph, triplets);
  return FindScaleArticulations(ratios, diagnosis, DiagnosisOptions());
}

TEST(FindScaleArticulations, IsTheCameraWhoseRatiosAloneJoinTwoParts) {
  std::vector<ScaleRatio> ratios = {
      RatioOf({0, 2, 1}),  // within a part: joins nothing
      RatioOf({1, 2, 3}, -20), RatioOf({4, 2, 0}, -30),
      RatioOf({0, 2, 3}, -25)};
  ratios[3].verdict = RatioVerdict::kNotMeaningful;
  const auto found = Find(kTwoTriangles, ratios);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].view, 2u);
  EXPECT_THAT(found[0].parts,
              ElementsAre(ElementsAre(0, 1), ElementsAre(3, 4)));
  EXPECT_THAT(found[0].ratios, ElementsAre(2, 1));
  EXPECT_FALSE(found[0].is_weak);
}

TEST(FindScaleArticulations, IsNoneWithoutARatioAcross) {
  EXPECT_THAT(Find(kTwoTriangles, {}), IsEmpty());
  EXPECT_THAT(Find(kTwoTriangles, {RatioOf({0, 2, 1})}), IsEmpty());
}

TEST(FindScaleArticulations, IsWeakUnlessAStrongRatioHoldsTheParts) {
  ScaleRatio weak = RatioOf({1, 2, 3});
  weak.log_ratio_stddev = 0.5;
  std::vector<ScaleRatio> ratios = {weak};
  ASSERT_EQ(Find(kTwoTriangles, ratios).size(), 1u);
  EXPECT_TRUE(Find(kTwoTriangles, ratios)[0].is_weak);
  ratios.push_back(RatioOf({0, 2, 4}));
  ASSERT_EQ(Find(kTwoTriangles, ratios).size(), 1u);
  EXPECT_FALSE(Find(kTwoTriangles, ratios)[0].is_weak);
}

TEST(FindScaleArticulations, OfAChainIsEveryInnerCamera) {
  ViewPairs chain;
  std::vector<ScaleRatio> ratios;
  for (std::uint32_t view = 0; view < 5; ++view) {
    chain.push_back({view, view + 1});
    if (view > 0) ratios.push_back(RatioOf({view - 1, view, view + 1}));
  }
  const auto found = Find(chain, ratios);
  ASSERT_EQ(found.size(), 4u);
  for (std::uint32_t n = 0; n < 4; ++n) EXPECT_EQ(found[n].view, n + 1);
  // The larger side comes first.
  EXPECT_THAT(found[0].parts,
              ElementsAre(ElementsAre(2, 3, 4, 5), ElementsAre(0)));
  EXPECT_THAT(found[3].parts,
              ElementsAre(ElementsAre(0, 1, 2, 3), ElementsAre(5)));
}

// A square with ratios across 0, 1 and 2: without any one of them, the other
// two leave two paths of known lengths or a path and two edges.
TEST(FindScaleArticulations, WhatDirectionsHoldWithoutTheRatioIsNone) {
  const ViewPairs square = {{0, 1}, {1, 2}, {2, 3}, {0, 3}};
  const std::vector<ScaleRatio> ratios = {
      RatioOf({3, 0, 1}), RatioOf({0, 1, 2}), RatioOf({1, 2, 3})};
  // Without that across 1: {3-0, 0-1} and {1-2, 2-3} share views 1 and 3.
  // Without that across 0 or 2: one edge and three, which share two views.
  EXPECT_THAT(Find(square, ratios), IsEmpty());
}

TEST(FindScaleArticulations, JudgesEveryGroupByItself) {
  // Two pairs of triangles that have nothing in common.
  ViewPairs edges = kTwoTriangles;
  for (const ViewPair& edge : kTwoTriangles) {
    edges.push_back({edge.first.value() + 10, edge.second.value() + 10});
  }
  ScaleRatio weak = RatioOf({11, 12, 13});
  weak.log10_nfa = -1;
  const auto found = Find(edges, {weak, RatioOf({1, 2, 3})});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].view, 2u);
  EXPECT_FALSE(found[0].is_weak);
  EXPECT_THAT(found[0].ratios, ElementsAre(1));
  EXPECT_EQ(found[1].view, 12u);
  EXPECT_TRUE(found[1].is_weak);
  EXPECT_THAT(found[1].parts,
              ElementsAre(ElementsAre(10, 11), ElementsAre(13, 14)));
}

TEST(SortByEvidence, IsStable) {
  std::vector<ScaleRatio> ratios;
  for (const double nfa : {-3.0, -9.0, -3.0, -20.0, -9.0}) {
    ratios.push_back(RatioOf({0, 1, 2}, nfa));
  }
  std::vector<std::size_t> indices = {4, 2, 0, 1, 3};
  SortByEvidence(ratios, &indices);
  EXPECT_THAT(indices, ElementsAre(3, 4, 1, 2, 0));
}

}  // namespace
}  // namespace lowlap
