#include <algorithm>
#include <cmath>
#include <numeric>

#include "lowlap/report/internal/base64.h"
#include "lowlap/report/internal/page_parts.h"

namespace lowlap {
namespace {

std::string EncodedFloats(const std::vector<double>& values) {
  return Base64(std::vector<float>(values.begin(), values.end()));
}

// Ascending places of `most` of so many things, those that come first in order.
template <class Order>
std::vector<std::size_t> ChooseFirst(std::size_t count, std::size_t most,
                                     const Order& comes_first) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  if (count > most) {
    std::stable_sort(places.begin(), places.end(), comes_first);
    places.resize(most);
    std::sort(places.begin(), places.end());
  }
  return places;
}

// Places of the two features of each match that the page has.
std::string PointMatches(const RelativePose& pose, const PageIndex& index) {
  std::vector<std::uint32_t> places;
  const auto first = index.features.find(pose.views.first);
  const auto second = index.features.find(pose.views.second);
  if (first == index.features.end() || second == index.features.end())
    return "";
  for (const FeatureMatch& match : pose.point_inliers) {
    if (match.first >= first->second.size() ||
        match.second >= second->second.size()) {
      continue;
    }
    const std::uint32_t from = first->second[match.first];
    const std::uint32_t to = second->second[match.second];
    if (from == kNoLandmark || to == kNoLandmark) continue;
    places.push_back(from);
    places.push_back(to);
  }
  return Base64(places);
}

std::string LineMatches(const RelativePose& pose) {
  std::vector<std::uint32_t> places;
  for (const FeatureMatch& match : pose.line_inliers) {
    places.push_back(match.first);
    places.push_back(match.second);
  }
  return Base64(places);
}

PageJson RatioJson(const ScaleRatio& ratio) {
  PageJson json = {{"verdict", RatioVerdictName(ratio.verdict)}};
  if (ratio.verdict == RatioVerdict::kNoCandidates) return json;
  json["log_ratio"] = ratio.log_ratio;
  json["low"] = ratio.IntervalLow();
  json["high"] = ratio.IntervalHigh();
  json["log10_nfa"] = ratio.log10_nfa;
  if (ratio.second_mode) {
    json["second"] = {ratio.second_mode->log_ratio,
                      ratio.second_mode->log10_nfa};
  }
  PageJson& kinds = json["kinds"] = PageJson::array();
  for (const KindSupport& kind : ratio.kinds) {
    kinds.push_back({kind.kind, kind.inliers, kind.candidates, kind.log10_nfa,
                     kind.information_share});
  }
  return json;
}

PageJson ProfileJson(const ReportProfile& profile, bool by_kind) {
  PageJson json = {{"log_ratios", EncodedFloats(profile.log_ratios)},
                   {"total", EncodedFloats(profile.log10_nfas)}};
  if (!by_kind) return json;
  for (const auto& [kind, values] : profile.kinds) {
    json["kinds"].push_back({kind, EncodedFloats(values)});
  }
  return json;
}

// log(|last - middle| / |middle - first|) of the true centres.
std::optional<double> TrueLogRatio(const ViewTriplet& views,
                                   const ReportTruth& truth) {
  const auto first = truth.poses.find(views.first);
  const auto middle = truth.poses.find(views.middle);
  const auto last = truth.poses.find(views.last);
  for (const auto& pose : {first, middle, last}) {
    if (pose == truth.poses.end()) return std::nullopt;
  }
  const Vec3& center = middle->second.center;
  const double log_ratio = std::log((last->second.center - center).norm() /
                                    (first->second.center - center).norm());
  if (!std::isfinite(log_ratio)) return std::nullopt;
  return log_ratio;
}

}  // namespace

PageJson PairsJson(const Scene& scene, const ReportContent& content,
                   const PageIndex& index, const PageLimits& limits) {
  PageJson pairs = PageJson::array();
  const std::vector<ReportPair>& all = content.pairs;
  const auto comes_first = [&](std::size_t a, std::size_t b) {
    return all[a].is_used != all[b].is_used
               ? all[a].is_used
               : all[a].log10_nfa < all[b].log10_nfa;
  };
  for (const std::size_t n :
       ChooseFirst(all.size(), limits.pairs, comes_first)) {
    const ReportPair& pair = all[n];
    PageJson json = {
        {"views",
         {index.views.at(pair.views.first), index.views.at(pair.views.second)}},
        {"used", pair.is_used},
        {"note", pair.note},
        {"point_matches", pair.num_point_matches},
        {"line_matches", pair.num_line_matches},
        {"log10_nfa", pair.log10_nfa}};
    const auto pose = scene.relative_poses.find(pair.views);
    if (pose != scene.relative_poses.end()) {
      json["point_inliers"] = pose->second.point_inliers.size();
      json["line_inliers"] = pose->second.line_inliers.size();
      json["points"] = PointMatches(pose->second, index);
      json["lines"] = LineMatches(pose->second);
    }
    pairs.push_back(std::move(json));
  }
  return pairs;
}

PageJson TripletsJson(const Scene& scene, const ReportContent& content,
                      const PageIndex& index, const PageLimits& limits) {
  const std::vector<ScaleRatio>& ratios = scene.scale_ratios;
  // Profiles are of the weakest ratios, which are asked about first.
  const auto comes_first = [&](std::size_t a, std::size_t b) {
    const bool has_a = content.profiles.count(ratios[a].views) > 0;
    const bool has_b = content.profiles.count(ratios[b].views) > 0;
    return has_a != has_b ? has_a : ratios[a].log10_nfa < ratios[b].log10_nfa;
  };
  const bool by_kind = content.profiles.size() <= limits.profiles_by_kind;
  PageJson triplets = PageJson::array();
  for (const std::size_t n :
       ChooseFirst(ratios.size(), limits.triplets, comes_first)) {
    const ViewTriplet& views = ratios[n].views;
    PageJson json = RatioJson(ratios[n]);
    json["views"] = {index.views.at(views.first), index.views.at(views.middle),
                     index.views.at(views.last)};
    if (content.truth) {
      if (const auto log_ratio = TrueLogRatio(views, *content.truth)) {
        json["true_log_ratio"] = *log_ratio;
      }
    }
    if (const auto profile = content.profiles.find(views);
        profile != content.profiles.end()) {
      json["profile"] = ProfileJson(profile->second, by_kind);
    }
    triplets.push_back(std::move(json));
  }
  return triplets;
}

}  // namespace lowlap
