#include "lowlap/scale/evidence/internal/coplanar_lines.h"

#include <array>
#include <utility>
#include <vector>

#include "lowlap/robust/internal/nfa.h"
#include "lowlap/scale/evidence/internal/coplanar_candidates.h"
#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/residual_evidence.h"

namespace lowlap {
namespace {

// How far the crossing of a tier may be, in units of the image diagonal.
constexpr std::array<double, 2> kTierOfDiagonal = {0.01, 0.035};
// Nearest lines that each line is paired with.
constexpr int kNearestLines = 10;
constexpr int kNumTiers = static_cast<int>(kTierOfDiagonal.size());

// kNumTiers: too far to be used.
int TierOfCrossing(double crossing_px, double image_diagonal_px) {
  int tier = 0;
  while (tier < kNumTiers &&
         crossing_px > kTierOfDiagonal[tier] * image_diagonal_px) {
    ++tier;
  }
  return tier;
}

class CoplanarLines : public ResidualEvidence<TransferResiduals> {
 public:
  explicit CoplanarLines(const TripletView& triplet)
      : image_area_px2_(triplet.image_area_px2) {
    const CoplanarPairCandidates found = FindCoplanarCandidates(
        triplet.geometry, triplet.lines_ij, triplet.lines_jk, kNearestLines);
    RejectNegative(found.num_rejected_negative);
    StartPairs(kNumTiers);
    for (int tier = 0; tier < kNumTiers; ++tier) {
      for (const CoplanarPairCandidate& pair : found.pairs) {
        if (TierOfCrossing(pair.crossing_px, triplet.image_diagonal_px) !=
            tier) {
          continue;
        }
        if (!AddPair(pair.ratio, tier, {pair.first, pair.last})) continue;
        residuals_.Add(triplet.geometry, triplet.lines_ij[pair.first],
                       triplet.lines_jk[pair.last], pair.ratio.log_ratio);
        pairs_.emplace_back(pair.first, pair.last);
      }
    }
  }

  // An error vanishes at the pair's own ratio, which every interval surrounds.
  double NumTests() const override { return size(); }
  NfaTerm PaperTerm(const LogFactorials& factorials,
                    const LadderCounts* counts) const override {
    LadderCounts both{};
    for (int step = 0; step < kNumThresholds; ++step) {
      both[step] = counts[0][step] + counts[1][step];
    }
    const auto& num_units = units().tiers.back().num_units;
    return PaperCoplanarTerm(factorials, num_units[0] + num_units[1], both,
                             image_area_px2_, kNearestLines);
  }
  int MinAgreeing() const override { return 3; }
  void RecordInliers(const TripletView& triplet,
                     const std::vector<int>& inliers,
                     ScaleRatio* ratio) const override {
    for (const int n : inliers) {
      ratio->coplanar_inliers.push_back(
          {triplet.lines_ij[pairs_[n].first].segment_in_middle,
           triplet.lines_jk[pairs_[n].second].segment_in_middle});
    }
  }

 protected:
  CandidateDetail DetailOf(const TripletView& triplet, int n) const override {
    const MatchedLine& a = triplet.lines_ij[pairs_[n].first];
    const MatchedLine& b = triplet.lines_jk[pairs_[n].second];
    const Vec3 crossing =
        CrossingInMiddle(a.in_middle.segment, b.in_middle.segment)
            .value_or(Vec3(Vec3::Zero()));
    return {crossing.head<2>(), NoiseOfCoplanarRatio(triplet.geometry, a, b)};
  }
  RatioCandidate RatioIn(const TripletView& triplet,
                         const TripletGeometry& geometry,
                         int n) const override {
    return CoplanarRatio(geometry, triplet.lines_ij[pairs_[n].first],
                         triplet.lines_jk[pairs_[n].second]);
  }

 private:
  double image_area_px2_;
  std::vector<std::pair<int, int>> pairs_;  // of lines_ij and lines_jk
};

}  // namespace

std::unique_ptr<Evidence> CoplanarLinesKind::Gather(
    const TripletView& triplet) const {
  return std::make_unique<CoplanarLines>(triplet);
}

}  // namespace lowlap
