#include "lowlap/matching/internal/points/subpixel_refinement.h"

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

struct TrackPatch {
  FeatureRef reference;
  std::optional<PointPatch> patch;
};

// What happens in one image.
struct ViewWork {
  ViewId view = kInvalidId;
  std::vector<std::size_t> references;  // tracks
  std::vector<std::pair<std::size_t, FeatureIndex>> others;
  std::size_t refined = 0;
};

// The observation of largest scale, of several the first.
FeatureRef Reference(const Track& track,
                     const std::map<ViewId, DetectedFeatures>& detected) {
  const auto scale = [&](const FeatureRef& ref) {
    return detected.at(ref.view).keypoints[ref.feature].scale_px;
  };
  FeatureRef best = track.front();
  for (const FeatureRef& ref : track) {
    if (scale(ref) > scale(best)) best = ref;
  }
  return best;
}

// Calls visit(pyramid, work) for every image, one per thread.
Status VisitImages(
    const Scene& scene, const std::string& stage, const RunContext& context,
    std::vector<ViewWork>* work,
    const std::function<void(const GrayPyramid&, ViewWork*)>& visit) {
  std::vector<Status> results(work->size());
  const Status done =
      ParallelFor(context, stage, work->size(), [&](std::size_t i) {
        ViewWork& view = (*work)[i];
        const Result<GrayImage> image =
            ReadGrayImage(scene.ImagePath(view.view));
        if (image) {
          visit(GrayPyramid(*image), &view);
        } else {
          results[i] = tl::unexpected<Error>(image.error());
        }
      });
  if (!done) return done;
  for (const Status& result : results) {
    if (!result) return result;
  }
  return {};
}

}  // namespace

Result<SubpixelSummary> RefinePointTracks(
    const std::map<ViewId, DetectedFeatures>& detected,
    const PatchAlignmentOptions& options, const RunContext& context,
    Scene* scene) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::map<ViewId, ViewWork> of_view;
  std::vector<TrackPatch> patches;
  SubpixelSummary summary;
  for (const auto& [id, track] : scene->point_tracks) {
    for (const FeatureRef& ref : track) {
      const auto view = detected.find(ref.view);
      if (view == detected.end() ||
          ref.feature >= view->second.keypoints.size()) {
        return MakeError(ErrorCode::kInvalidArgument,
                         "point track " + std::to_string(id.value()) +
                             " has a feature without a keypoint");
      }
    }
    const FeatureRef reference = Reference(track, detected);
    for (const FeatureRef& ref : track) {
      ViewWork& work = of_view[ref.view];
      if (ref == reference) {
        work.references.push_back(patches.size());
      } else {
        work.others.emplace_back(patches.size(), ref.feature);
        ++summary.observations;
      }
    }
    patches.push_back({reference, std::nullopt});
  }
  std::vector<ViewWork> work;
  for (auto& [id, view] : of_view) {
    view.view = id;
    work.push_back(std::move(view));
  }

  const auto keypoint = [&](const FeatureRef& ref) -> const Keypoint& {
    return detected.at(ref.view).keypoints[ref.feature];
  };
  Status done = VisitImages(*scene, "point patches", context, &work,
                            [&](const GrayPyramid& image, ViewWork* view) {
                              for (const std::size_t track : view->references) {
                                TrackPatch& t = patches[track];
                                t.patch =
                                    ExtractPatch(image, keypoint(t.reference));
                              }
                            });
  if (!done) return tl::unexpected<Error>(done.error());

  std::map<ViewId, std::vector<Vec2>> moved;
  for (const ViewWork& view : work) {
    moved[view.view] = scene->features.at(view.view).points_px;
  }
  done = VisitImages(*scene, "point alignment", context, &work,
                     [&](const GrayPyramid& image, ViewWork* view) {
                       std::vector<Vec2>& points = moved.at(view->view);
                       for (const auto& [track, feature] : view->others) {
                         const TrackPatch& t = patches[track];
                         if (!t.patch) continue;
                         const std::optional<Vec2> place = AlignPatch(
                             *t.patch, keypoint(t.reference),
                             keypoint({view->view, feature}), image, options);
                         if (!place) continue;
                         points[feature] = *place;
                         ++view->refined;
                       }
                     });
  if (!done) return tl::unexpected<Error>(done.error());
  for (const ViewWork& view : work) {
    scene->features.at(view.view).points_px = std::move(moved.at(view.view));
    summary.refined += view.refined;
  }
  return summary;
}

}  // namespace lowlap
