#include "lowlap/two_view/internal/planes/motion_lead.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "lowlap/two_view/internal/planes/parallax_evidence.h"

namespace lowlap {
namespace {

constexpr double kDecisiveScore = 23;
constexpr double kDecisiveDeviations = 3;
const double kTellingScore = std::log(10.0);

}  // namespace

bool MotionLead::IsDecisive() const {
  return std::abs(of_all) >=
         std::max(kDecisiveScore, kDecisiveDeviations * noise);
}

bool MotionLead::IsBehind() const {
  const bool beside_plane_tells =
      !IsDecisive() && std::abs(beside_plane) >= kTellingScore;
  return (beside_plane_tells ? beside_plane : of_all) < 0;
}

MotionLead CompareMotions(const PoseSearch& search, const PointPairs& pairs,
                          const PoseCandidate& first,
                          const ScenePlane& plane_of_first,
                          const PoseCandidate& second,
                          const ScenePlane* plane_of_second) {
  const double threshold_px = first.support.threshold;
  // Wider than the loss: what noise alone makes of it must stay small.
  const double scale_px = 0.5 * threshold_px;
  std::vector<double> leads = search.CoreScores(first.pose, scale_px);
  const std::vector<double> scores = search.CoreScores(second.pose, scale_px);
  double of_points = 0;
  for (std::size_t i = 0; i < leads.size(); ++i) {
    leads[i] -= scores[i];
    of_points += leads[i];
  }
  double off_plane = 0;
  for (const DisplacedMatch& match :
       DisplacedMatches(first.pose, plane_of_first, pairs, threshold_px)) {
    off_plane += leads[match.pair];
    leads[match.pair] = 0;
  }
  double squared = 0;
  for (const double lead : leads) squared += lead * lead;

  MotionLead lead;
  const double of_directions =
      std::log(10.0) * (second.direction_penalty - first.direction_penalty);
  lead.of_all = of_directions + of_points;
  lead.noise = std::sqrt(squared);
  lead.beside_plane = of_directions;
  const auto is_borne_out = [&](const PoseCandidate& motion,
                                const ScenePlane& plane) {
    return ParallaxEvidence(motion.pose, plane, pairs, threshold_px) < 0;
  };
  if (is_borne_out(first, plane_of_first) ||
      (plane_of_second != nullptr && is_borne_out(second, *plane_of_second))) {
    lead.beside_plane += off_plane;
  }
  return lead;
}

}  // namespace lowlap
