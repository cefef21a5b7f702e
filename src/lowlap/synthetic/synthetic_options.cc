#include <array>
#include <cmath>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/synthetic/internal/pair_graph.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

constexpr std::array<std::pair<SyntheticKind, const char*>, 9> kNames = {{
    {SyntheticKind::kRoom, "room"},
    {SyntheticKind::kCorridor, "corridor"},
    {SyntheticKind::kRing, "ring"},
    {SyntheticKind::kHouse, "house"},
    {SyntheticKind::kCloud, "cloud"},
    {SyntheticKind::kPlanar, "planar"},
    {SyntheticKind::kCollinear, "collinear"},
    {SyntheticKind::kPureRotation, "pure_rotation"},
    {SyntheticKind::kTwins, "twins"},
}};

// Beyond this the pairs of a room, where everybody sees everything, explode.
constexpr int kMaxViewsForAllPairs = 500;
constexpr int kMaxViews = 100'000;
constexpr int kMaxFeaturesPerWall = 1'000'000;

Status Invalid(const std::string& message) {
  return MakeError(ErrorCode::kInvalidArgument, message);
}

}  // namespace

const char* SyntheticKindName(SyntheticKind kind) {
  for (const auto& [known, name] : kNames) {
    if (known == kind) return name;
  }
  return "";
}

std::optional<SyntheticKind> SyntheticKindFromName(const std::string& name) {
  for (const auto& [kind, known] : kNames) {
    if (name == known) return kind;
  }
  return std::nullopt;
}

Status SyntheticOptions::Validate() const {
  if (num_views < 2 || num_views > kMaxViews) {
    return Invalid("num_views must be in [2, " + std::to_string(kMaxViews) +
                   "]");
  }
  LOWLAP_ASSIGN_OR_RETURN(const PairRule rule, PairRule::Parse(pairs));
  if (rule.all && num_views > kMaxViewsForAllPairs) {
    return Invalid("pairs 'all' needs num_views <= " +
                   std::to_string(kMaxViewsForAllPairs));
  }
  const std::pair<const char*, int> counts[] = {
      {"points_per_wall", points_per_wall}, {"lines_per_wall", lines_per_wall}};
  for (const auto& [name, value] : counts) {
    if (value < 0 || value > kMaxFeaturesPerWall) {
      return Invalid(std::string(name) + " must be in [0, " +
                     std::to_string(kMaxFeaturesPerWall) + "]");
    }
  }
  const std::pair<const char*, double> shares[] = {
      {"trifocal_point_share", trifocal_point_share},
      {"trifocal_line_share", trifocal_line_share},
      {"broken_line_share", broken_line_share},
      {"wrong_point_share", wrong_point_share},
      {"wrong_line_share", wrong_line_share},
      {"wrong_direction_share", wrong_direction_share},
      {"wrong_pose_share", wrong_pose_share},
      {"wrong_candidate_share", wrong_candidate_share},
      {"alike_share", alike_share}};
  for (const auto& [name, value] : shares) {
    if (!(value >= 0 && value <= 1)) {
      return Invalid(std::string(name) + " must be in [0, 1]");
    }
  }
  LOWLAP_RETURN_IF_ERROR(
      RequireNotNegative({{noise_px, "noise_px"},
                          {rotation_noise_deg, "rotation_noise_deg"},
                          {direction_noise_deg, "direction_noise_deg"},
                          {pose_noise_factor, "pose_noise_factor"},
                          {off_line_m, "off_line_m"},
                          {twin_baseline_m, "twin_baseline_m"},
                          {wall_bulge_m, "wall_bulge_m"},
                          {box_offset_m, "box_offset_m"}}));
  if (width_px < 16 || height_px < 16) {
    return Invalid("width_px and height_px must be at least 16");
  }
  if (!IsPositive(focal_px)) {
    return Invalid("focal_px must be finite and positive");
  }
  // Less, and the sections are as many as the points.
  constexpr double kMinSection_m = 0.1;
  if (!(std::isfinite(section_m) && section_m >= kMinSection_m)) {
    return Invalid("section_m must be finite and at least 0.1");
  }
  return {};
}

}  // namespace lowlap
