#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "lowlap/report/internal/display_frame.h"
#include "lowlap/report/internal/page_data.h"
#include "lowlap/report/internal/report.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

using PageJson = nlohmann::ordered_json;

/// Of a feature without a landmark, and of one whose landmark is not shown.
inline constexpr std::uint32_t kNoLandmark = 0xFFFFFFFF;
inline constexpr std::uint32_t kHiddenLandmark = 0xFFFFFFFE;

/// Places of things in the page, which has no ids: views, landmarks that are
/// shown, and the features of each view that are kept.
struct PageIndex {
  std::map<ViewId, std::uint32_t> views;
  std::map<PointTrackId, std::uint32_t> points;
  std::map<LineTrackId, std::uint32_t> lines;
  /// By feature: its place among the kept ones, or kNoLandmark.
  std::map<ViewId, std::vector<std::uint32_t>> features;
  std::size_t point_stride = 1;    // every how many-th point is shown
  std::size_t feature_stride = 1;  // and every how many-th track of features
};

PageIndex MakePageIndex(const Scene& scene, const PageLimits& limits);

/// The solution before the adjustment in the gauge of the one after it, by
/// their cameras (AlignPoses). As it is, if that is impossible.
ReportStage AlignToScene(const ReportStage& before, const Scene& scene);

PageJson ViewsJson(const Scene& scene, const ReportContent& content,
                   const std::optional<ReportStage>& before,
                   const PageIndex& index, const DisplayFrame& frame,
                   const PageLimits& limits);

/// Members `points`, `lines` and `coplanar_pairs`; `before` only where there is
/// such a stage. Landmarks that were not there then have NaN.
void AddStructure(const Scene& scene, const std::optional<ReportStage>& before,
                  const PageIndex& index, const DisplayFrame& frame,
                  PageJson* page);

PageJson PairsJson(const Scene& scene, const ReportContent& content,
                   const PageIndex& index, const PageLimits& limits);

PageJson TripletsJson(const Scene& scene, const ReportContent& content,
                      const PageIndex& index, const PageLimits& limits);

/// Histograms of the residuals of points and lines in px over equal bins, and
/// their RMSE, of the scene, of every view, and before the adjustment; the
/// median of the scene.
PageJson ResidualsJson(const Scene& scene, const ReportContent& content,
                       const PageIndex& index);

}  // namespace lowlap
