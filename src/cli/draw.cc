#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "lowlap/core/internal/atomic_file.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/overlay.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/scene/internal/view_names.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct DrawFlags {
  CommonFlags common;
  std::string scene;
  std::string images;
  std::string output;
  std::vector<std::string> views;
  std::vector<std::string> pairs;
  int width_px = 1600;
};

// What is asked for.
struct Selection {
  std::set<ViewId> views;
  std::set<ViewPair> pairs;
};

// Names may hold hyphens: of all places to split, the one with a view on either
// side.
Result<ViewPair> FindPair(const Scene& scene, const ViewNames& names,
                          const std::string& word) {
  for (std::size_t at = word.find('-'); at != std::string::npos;
       at = word.find('-', at + 1)) {
    const auto first = names.Find(word.substr(0, at));
    const auto second = names.Find(word.substr(at + 1));
    if (!first || !second) continue;
    if (const RelativePose* pose = scene.FindRelativePose(*first, *second)) {
      return pose->views;
    }
    return MakeError(ErrorCode::kInvalidArgument,
                     "--pairs: there is no relative pose between the views '" +
                         word.substr(0, at) + "' and '" + word.substr(at + 1) +
                         "'");
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "--pairs: '" + word +
                       "' is not two views joined by a hyphen, such as "
                       "0001-0002");
}

Result<Selection> Select(const Scene& scene, const DrawFlags& flags) {
  Selection selection;
  const ViewNames names(scene);
  for (const std::string& word : flags.views) {
    LOWLAP_ASSIGN_OR_RETURN(const ViewId view, names.Find(word));
    selection.views.insert(view);
  }
  for (const std::string& word : flags.pairs) {
    LOWLAP_ASSIGN_OR_RETURN(const ViewPair pair, FindPair(scene, names, word));
    selection.pairs.insert(pair);
  }
  if (!flags.views.empty() || !flags.pairs.empty()) return selection;
  for (const auto& [id, view] : scene.views) selection.views.insert(id);
  return selection;
}

// The image of a view, which its features must fit.
Result<GrayImage> ReadImageOf(const Scene& scene, ViewId id) {
  const std::string path = scene.ImagePath(id);
  const View& view = scene.views.at(id);
  LOWLAP_ASSIGN_OR_RETURN(GrayImage image, ReadGrayImage(path));
  if (image.width != view.width_px || image.height != view.height_px) {
    return MakeError(
        ErrorCode::kInvalidScene,
        Format("the image has %d x %d pixels, its view in the scene %d x %d",
               image.width, image.height, view.width_px, view.height_px),
        path);
  }
  return image;
}

const ViewFeatures& FeaturesOf(const Scene& scene, ViewId id) {
  static const ViewFeatures kNone;
  const auto found = scene.features.find(id);
  return found == scene.features.end() ? kNone : found->second;
}

Result<std::string> DrawView(const Scene& scene, ViewId id, int width_px) {
  LOWLAP_ASSIGN_OR_RETURN(const GrayImage image, ReadImageOf(scene, id));
  std::set<FeatureIndex> points, segments;
  for (const auto& [track, landmark] : scene.structure) {
    for (const PointObservation& seen : landmark.observations) {
      if (seen.view == id) points.insert(seen.feature);
    }
  }
  for (const auto& [track, line] : scene.line_structure) {
    for (const FeatureRef& seen : line.observations) {
      if (seen.view == id) segments.insert(seen.feature);
    }
  }
  return DrawInliers(image, FeaturesOf(scene, id), points, segments, width_px);
}

Result<std::string> DrawPair(const Scene& scene, const ViewPair& pair,
                             int width_px) {
  LOWLAP_ASSIGN_OR_RETURN(const auto first, ReadImageOf(scene, pair.first));
  LOWLAP_ASSIGN_OR_RETURN(const auto second, ReadImageOf(scene, pair.second));
  const RelativePose& pose = scene.relative_poses.at(pair);
  return DrawMatches({&first, &FeaturesOf(scene, pair.first)},
                     {&second, &FeaturesOf(scene, pair.second)},
                     pose.point_inliers, pose.line_inliers, width_px);
}

// Names alone need not differ: views may lie in several folders.
std::string FileStem(const Scene& scene, ViewId id) {
  const std::filesystem::path name = scene.views.at(id).filename;
  return std::to_string(id.value()) + "_" + name.stem().string();
}

Result<int> Draw(const DrawFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  LOWLAP_ASSIGN_OR_RETURN(auto scene, ReadScene(flags.scene));
  if (!flags.images.empty()) scene.root_path = flags.images;
  LOWLAP_ASSIGN_OR_RETURN(const Selection selection, Select(scene, flags));

  OutputFolder folder;
  LOWLAP_RETURN_IF_ERROR(folder.Make(flags.output));
  FileSet files;
  std::mutex files_mutex;
  const std::vector<ViewId> views(selection.views.begin(),
                                  selection.views.end());
  const std::vector<ViewPair> pairs(selection.pairs.begin(),
                                    selection.pairs.end());
  const std::size_t num_views = views.size();
  std::vector<Status> drawn(num_views + pairs.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, "drawing", drawn.size(), [&](std::size_t n) {
        std::string name;
        Result<std::string> png;
        if (n < num_views) {
          const ViewId id = views[n];
          name = "view_" + FileStem(scene, id);
          png = DrawView(scene, id, flags.width_px);
        } else {
          const ViewPair& pair = pairs[n - num_views];
          name = "pair_" + FileStem(scene, pair.first) + "-" +
                 FileStem(scene, pair.second);
          png = DrawPair(scene, pair, flags.width_px);
        }
        if (!png) {
          drawn[n] = tl::unexpected<Error>(png.error());
          return;
        }
        const std::lock_guard<std::mutex> lock(files_mutex);
        drawn[n] = files.Add(flags.output + "/" + name + ".png", *png);
      }));
  for (const Status& status : drawn) LOWLAP_RETURN_IF_ERROR(status);
  LOWLAP_RETURN_IF_ERROR(files.Commit());
  std::printf("%zu views and %zu pairs drawn in %s\n", num_views, pairs.size(),
              flags.output.c_str());
  return 0;
}

}  // namespace

void AddDraw(CLI::App* program, Action* action) {
  auto flags = std::make_shared<DrawFlags>();
  CLI::App* command = AddCommand(
      program, "draw",
      "Draw the photographs of a scene with their features as PNG files: those "
      "of landmarks bright, the others pale; and pairs side by side with the "
      "inlier matches of their relative pose. All views, unless some are "
      "named");
  AddOption(command, "scene", flags->scene, "Scene file").Required();
  AddOption(command, "--images", flags->images,
            "Folder of the photographs; default: where the scene says");
  AddOption(command, "-o,--output", flags->output, "Folder for the pictures")
      .Required();
  AddOption(command, "--views", flags->views,
            "Views to draw, separated by commas")
      .SeparatedBy(',');
  AddOption(command, "--pairs", flags->pairs,
            "Pairs to draw, A-B, separated by commas")
      .SeparatedBy(',');
  AddOption(command, "--width", flags->width_px,
            "Largest width of a photograph in a picture, in pixels")
      .Must(Check::Between(16, 100000))
      .ShowDefault();
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Draw, action);
}

}  // namespace lowlap::cli
