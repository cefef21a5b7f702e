#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "lowlap/adjustment/internal/costs/projection.h"
#include "lowlap/adjustment/internal/costs/segment_rays.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/report/internal/page_parts.h"

namespace lowlap {
namespace {

constexpr std::size_t kNumBins = 40;

// One residual: where, and how large.
struct Residual {
  ViewId view;
  double error_px = 0;
};

// A stage of the solution, as residuals need it.
struct Stage {
  std::function<const Pose*(ViewId)> pose;
  std::function<const Intrinsic*(ViewId)> intrinsic;
  std::function<const Vec3*(PointTrackId)> point;
  std::function<std::optional<PluckerLine>(LineTrackId)> line;
};

template <class Map, class Key>
auto FindIn(const Map& map, const Key& key) -> const
    typename Map::mapped_type* {
  const auto found = map.find(key);
  return found == map.end() ? nullptr : &found->second;
}

Stage AfterAdjustment(const Scene& scene) {
  Stage stage;
  stage.pose = [&](ViewId view) { return scene.FindPose(view); };
  stage.intrinsic = [&](ViewId view) { return scene.FindIntrinsic(view); };
  stage.point = [&](PointTrackId id) {
    return &scene.structure.at(id).position;
  };
  stage.line = [&](LineTrackId id) { return scene.line_structure.at(id).line; };
  return stage;
}

Stage BeforeAdjustment(const Scene& scene, const ReportStage& before) {
  Stage stage;
  stage.pose = [&](ViewId view) {
    return FindIn(before.poses, scene.views.at(view).pose_id);
  };
  stage.intrinsic = [&](ViewId view) {
    const Intrinsic* given =
        FindIn(scene.given_intrinsics, scene.views.at(view).intrinsic_id);
    return given != nullptr ? given : scene.FindIntrinsic(view);
  };
  stage.point = [&](PointTrackId id) { return FindIn(before.points, id); };
  stage.line = [&](LineTrackId id) -> std::optional<PluckerLine> {
    const auto* ends = FindIn(before.lines, id);
    if (ends == nullptr || (*ends)[0] == (*ends)[1]) return std::nullopt;
    return PluckerLine::FromPoints((*ends)[0], (*ends)[1]);
  };
  return stage;
}

// Distance of the observed pixel from the projected point, in the photograph.
std::vector<Residual> PointResiduals(const Scene& scene, const Stage& stage) {
  std::vector<Residual> residuals;
  for (const auto& [id, landmark] : scene.structure) {
    const Vec3* point = stage.point(id);
    if (point == nullptr) continue;
    for (const PointObservation& seen : landmark.observations) {
      const Pose* pose = stage.pose(seen.view);
      const Intrinsic* intrinsic = stage.intrinsic(seen.view);
      if (pose == nullptr || intrinsic == nullptr) continue;
      const auto error_px = ProjectionErrorPx(
          *intrinsic, pose->CamFromWorld() * *point, seen.pixel_px);
      if (error_px) residuals.push_back({seen.view, error_px->norm()});
    }
  }
  return residuals;
}

// Root mean square distance of the ends of the segment from the image of the
// line, in the photograph.
std::vector<Residual> LineResiduals(const Scene& scene, const Stage& stage) {
  std::vector<Residual> residuals;
  for (const auto& [id, landmark] : scene.line_structure) {
    const auto line = stage.line(id);
    if (!line) continue;
    for (const FeatureRef& seen : landmark.observations) {
      const Pose* pose = stage.pose(seen.view);
      const Intrinsic* intrinsic = stage.intrinsic(seen.view);
      const auto features = scene.features.find(seen.view);
      if (pose == nullptr || intrinsic == nullptr ||
          features == scene.features.end() ||
          seen.feature >= features->second.segments.size()) {
        continue;
      }
      IntrinsicState camera;
      camera.value = *intrinsic;
      const auto rays = MakeSegmentRays(features->second.segments[seen.feature],
                                        camera, false);
      if (!rays) continue;
      const Vec3 normal = (pose->CamFromWorld() * *line).moment;
      residuals.push_back(
          {seen.view,
           std::hypot(EndPointDistancePx(rays->ends[0], normal, nullptr),
                      EndPointDistancePx(rays->ends[1], normal, nullptr)) /
               std::sqrt(2.0)});
    }
  }
  return residuals;
}

// Of what lies beyond the last bin only the number is known.
struct Histogram {
  std::array<int, kNumBins> counts{};
  int beyond = 0;
  int total = 0;
  double sum_squares = 0;

  void Add(double error_px, double bin_px) {
    const double bin = error_px / bin_px;
    if (bin < kNumBins) {
      ++counts[static_cast<std::size_t>(bin)];
    } else {
      ++beyond;
    }
    ++total;
    sum_squares += error_px * error_px;
  }
  PageJson ToJson() const {
    PageJson json = {{"counts", counts},
                     {"beyond", beyond},
                     {"total", total},
                     {"rmse_px", nullptr}};
    if (total > 0) json["rmse_px"] = std::sqrt(sum_squares / total);
    return json;
  }
};

// With the median: before the adjustment a few residuals, however large, are
// most of the RMSE.
PageJson StageJson(const std::vector<Residual>& residuals, double bin_px) {
  Histogram histogram;
  std::vector<double> errors;
  errors.reserve(residuals.size());
  for (const Residual& residual : residuals) {
    histogram.Add(residual.error_px, bin_px);
    errors.push_back(residual.error_px);
  }
  PageJson json = histogram.ToJson();
  json["median_px"] = nullptr;
  if (!errors.empty()) json["median_px"] = Median(std::move(errors));
  return json;
}

// All but a hundredth lie within the bins.
double ChooseBin(const std::vector<Residual>& residuals) {
  std::vector<double> errors;
  errors.reserve(residuals.size());
  for (const Residual& residual : residuals)
    errors.push_back(residual.error_px);
  if (errors.empty()) return 1;
  const auto last =
      errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 99 / 100);
  std::nth_element(errors.begin(), last, errors.end());
  return *last > 0 ? *last / kNumBins : 1;
}

PageJson KindJson(const std::vector<Residual>& after,
                  const std::vector<Residual>* before, const PageIndex& index) {
  const double bin_px = ChooseBin(after);
  PageJson json = {{"bin_px", bin_px}, {"after", StageJson(after, bin_px)}};
  if (before != nullptr) {
    json["before"] = StageJson(*before, bin_px);
  }
  std::vector<Histogram> views(index.views.size());
  for (const Residual& residual : after) {
    views[index.views.at(residual.view)].Add(residual.error_px, bin_px);
  }
  for (const Histogram& view : views) json["views"].push_back(view.ToJson());
  return json;
}

}  // namespace

PageJson ResidualsJson(const Scene& scene, const ReportContent& content,
                       const PageIndex& index) {
  const Stage after = AfterAdjustment(scene);
  const auto points = PointResiduals(scene, after);
  const auto lines = LineResiduals(scene, after);
  if (!content.before_adjustment) {
    return {{"points", KindJson(points, nullptr, index)},
            {"lines", KindJson(lines, nullptr, index)}};
  }
  const Stage before = BeforeAdjustment(scene, *content.before_adjustment);
  const auto points_before = PointResiduals(scene, before);
  const auto lines_before = LineResiduals(scene, before);
  return {{"points", KindJson(points, &points_before, index)},
          {"lines", KindJson(lines, &lines_before, index)}};
}

}  // namespace lowlap
