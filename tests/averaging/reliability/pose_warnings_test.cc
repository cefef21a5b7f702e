#include "lowlap/averaging/reliability/internal/pose_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lowlap {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Views a.jpg, b.jpg, ... of ids 0, 1, ...
Scene FiveViews() {
  Scene scene;
  for (std::uint32_t view = 0; view < 5; ++view) {
    scene.views[view].filename = std::string(1, "abcde"[view]) + ".jpg";
  }
  return scene;
}

std::vector<std::string> Warnings(const PoseSummary& summary) {
  return PoseWarnings(summary, FiveViews());
}

TEST(PoseWarnings, AreNoneIfAllIsWell) {
  PoseSummary summary;
  summary.num_views = summary.num_placed = 5;
  summary.num_edges = 9;
  summary.components = {{0, 1, 2, 3, 4}};
  EXPECT_THAT(Warnings(summary), IsEmpty());
}

TEST(PoseWarnings, NameViewsThatAreNotPlaced) {
  PoseSummary summary;
  summary.unplaced = {1, 4, 12};
  // An id that the scene does not have stands for itself.
  EXPECT_THAT(Warnings(summary),
              ElementsAre(HasSubstr("the others: b.jpg, e.jpg, 12.")));
}

TEST(PoseWarnings, NameWhatHangsOnAContestedLink) {
  PoseSummary summary;
  summary.contested = {{{0, 1}, {{0, 2}, {1, 3}}, {3, 4}}};
  EXPECT_THAT(
      Warnings(summary),
      ElementsAre("Doubtful: only the relative pose a.jpg - b.jpg places "
                  "d.jpg, e.jpg, and it is contradicted by a.jpg - c.jpg, "
                  "b.jpg - d.jpg, which have less evidence."));
}

TEST(PoseWarnings, SayByHowMuchALoopDoesNotCloseAndWhatBecameOfIt) {
  PoseSummary summary;
  LoopClosing loop;
  loop.edges = {{0, 1}, {1, 2}, {0, 2}};
  loop.closing_deg = 3.456;
  loop.expected_deg = 0.5;
  summary.loops = {loop};
  EXPECT_THAT(
      Warnings(summary),
      ElementsAre(AllOf(HasSubstr("a loop of 3 relative poses"),
                        HasSubstr("by 3.46 degrees (0.50 expected)"),
                        HasSubstr("all are used: a.jpg - b.jpg, b.jpg - c.jpg, "
                                  "a.jpg - c.jpg."),
                        Not(HasSubstr("left out")))));
  summary.loops[0].left_out = ViewPair{1, 2};
  EXPECT_THAT(Warnings(summary),
              ElementsAre(AllOf(
                  HasSubstr("least evidence, b.jpg - c.jpg, was left out: a."),
                  Not(HasSubstr("all are used")))));
}

TEST(PoseWarnings, NameWeakRatios) {
  PoseSummary summary;
  summary.weak_ratios = {{0, 1, 2}, {2, 3, 4}};
  EXPECT_THAT(
      Warnings(summary),
      ElementsAre(HasSubstr(": a.jpg, b.jpg, c.jpg; c.jpg, d.jpg, e.jpg.")));
}

TEST(PoseWarnings, NameTheRatioThatWasLeftOut) {
  PoseSummary summary;
  summary.left_out_ratios = {{0, 1, 2}};
  EXPECT_THAT(Warnings(summary),
              ElementsAre(AllOf(HasSubstr("Scale ratios left out"),
                                HasSubstr("(1): a.jpg, b.jpg, c.jpg."))));
}

TEST(PoseWarnings, GiveTheReasonOfEveryReliabilityWarning) {
  PoseSummary summary;
  ReliabilityWarning contradicted;
  contradicted.reason = WarningReason::kContradictedPoses;
  contradicted.views = {3};
  contradicted.against = {{2, 3}};
  ReliabilityWarning weak;
  weak.reason = WarningReason::kWeakScale;
  weak.views = {0, 1};
  weak.ratios = {{0, 1, 2}};
  ReliabilityWarning ratios = weak;
  ratios.reason = WarningReason::kContradictedRatios;
  ReliabilityWarning lost;
  lost.reason = WarningReason::kLostFeatures;
  lost.views = {4};
  lost.share = 0.29;
  ReliabilityWarning imprecise;
  imprecise.reason = WarningReason::kImprecise;
  imprecise.views = {2};
  imprecise.share = 0.042;
  ReliabilityWarning missing;
  missing.reason = WarningReason::kMissingMatches;
  missing.views = {0};
  for (std::uint32_t n = 0; n < 7; ++n) missing.missing.push_back({0, 4});
  missing.missing[0] = {0, 3};
  ReliabilityWarning alike = missing;
  alike.reason = WarningReason::kLookAlikes;
  alike.views = {3};
  summary.reliability_warnings = {contradicted, weak,  ratios,   lost,
                                  missing,      alike, imprecise};
  EXPECT_THAT(
      Warnings(summary),
      ElementsAre(
          AllOf(HasSubstr("Doubtful: d.jpg: more of the evidence"),
                HasSubstr("they contradict: c.jpg - d.jpg.")),
          AllOf(HasSubstr("Doubtful: a.jpg, b.jpg: only weak scale ratios"),
                HasSubstr(": a.jpg, b.jpg, c.jpg.")),
          AllOf(HasSubstr("Doubtful: a.jpg, b.jpg: the scale ratios"),
                HasSubstr("rejected were: a.jpg, b.jpg, c.jpg.")),
          // No less than it is, as cutting 28.999... off would say.
          AllOf(HasSubstr("Doubtful: e.jpg: most of what"),
                HasSubstr(": 29 % fits.")),
          AllOf(HasSubstr("Doubtful: a.jpg: at their places they, or views"),
                HasSubstr(": a.jpg - d.jpg, a.jpg - e.jpg, "),
                HasSubstr("a.jpg - e.jpg, and 2 more.")),
          AllOf(HasSubstr("Doubtful: d.jpg: what they or views beside them"),
                HasSubstr(": a.jpg - d.jpg, a.jpg - e.jpg, ")),
          AllOf(HasSubstr("Doubtful: c.jpg: by their deviations"),
                HasSubstr(
                    ": a standard deviation of 4.2 % of the scene's size."))));
}

TEST(PoseWarnings, CountWhatNothingChecks) {
  PoseSummary summary;
  summary.num_edges = 7;
  summary.unchecked = {{0, 1}, {1, 2}};
  EXPECT_THAT(Warnings(summary),
              ElementsAre(AllOf(HasSubstr("Of the 7 "), HasSubstr("(2)."))));
}

TEST(PoseWarnings, ListWhatWasLeftOutByReason) {
  PoseSummary summary;
  summary.outlier_edges = {{{0, 1}, OutlierReason::kDirection, 9},
                           {{0, 2}, OutlierReason::kRotation, 8},
                           {{1, 2}, OutlierReason::kDirection, 7},
                           {{1, 4}, OutlierReason::kContradicted, 6},
                           {{3, 4}, OutlierReason::kOutweighed, 0},
                           {{0, 4}, OutlierReason::kLookAlike, 0},
                           // Its loop says so already.
                           {{2, 3}, OutlierReason::kOpenLoop, 5}};
  EXPECT_THAT(
      Warnings(summary),
      ElementsAre(
          AllOf(HasSubstr("rotations contradict"), HasSubstr("(1): a.jpg - c")),
          AllOf(HasSubstr("directions contradict"),
                HasSubstr("(2): a.jpg - b.jpg, b.jpg - c.jpg.")),
          AllOf(HasSubstr("no cycle confirms"), HasSubstr("(1): b.jpg - e")),
          AllOf(HasSubstr("third views"), HasSubstr("(1): d.jpg - e")),
          AllOf(HasSubstr("look alike"), HasSubstr("(1): a.jpg - e"))));
}

TEST(PoseWarnings, InShortThereIsOneForEveryCause) {
  PoseSummary summary;
  ReliabilityWarning lost;
  lost.reason = WarningReason::kLostFeatures;
  lost.views = {4};
  ReliabilityWarning weak;
  weak.reason = WarningReason::kWeakScale;
  weak.views = {0, 1};
  weak.ratios = {{0, 1, 2}};
  summary.reliability_warnings = {lost, weak, lost};
  summary.reliability_warnings[2].views = {2};
  summary.outlier_edges = {{{0, 1}, OutlierReason::kDirection, 9},
                           {{1, 2}, OutlierReason::kDirection, 7}};
  EXPECT_THAT(
      PoseWarningsByCause(summary, FiveViews()),
      ElementsAre("Doubtful, since most of what was matched in them does not "
                  "fit their places: c.jpg, e.jpg.",
                  "Doubtful, since only weak scale ratios join them to the "
                  "others: a.jpg, b.jpg.",
                  "Relative poses left out because their directions contradict "
                  "the solved centres (2)."));
}

}  // namespace
}  // namespace lowlap
