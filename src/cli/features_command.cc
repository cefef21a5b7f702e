#include <chrono>
#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/features/internal/overlay.h"

namespace lowlap::cli {
namespace {

struct FeaturesFlags {
  std::string image;
  std::string draw;
  bool points = false;
  bool lines = false;
};

class Stopwatch {
 public:
  double Milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_)
        .count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

Result<int> Features(const FeaturesFlags& flags) {
  LOWLAP_RETURN_IF_ERROR(
      CheckDistinct({{"the image", flags.image}}, {{"--draw", flags.draw}}));
  const bool both = flags.points == flags.lines;
  LOWLAP_ASSIGN_OR_RETURN(const auto image, ReadGrayImage(flags.image));
  const double megapixels = 1e-6 * image.width * image.height;
  std::printf("%s: %d x %d px\n", flags.image.c_str(), image.width,
              image.height);
  ViewFeatures features;
  if (flags.points || both) {
    const Stopwatch stopwatch;
    LOWLAP_ASSIGN_OR_RETURN(const auto points, DetectPoints(image, {}));
    for (const Keypoint& keypoint : points.keypoints) {
      features.points_px.push_back(keypoint.position_px);
    }
    const double ms = stopwatch.Milliseconds();
    std::printf("points:   %6zu, %7.1f ms, %6.1f ms per megapixel\n",
                features.points_px.size(), ms, ms / megapixels);
  }
  if (flags.lines || both) {
    const Stopwatch stopwatch;
    LOWLAP_ASSIGN_OR_RETURN(auto segments, DetectLines(image, {}));
    const double ms = stopwatch.Milliseconds();
    LOWLAP_RETURN_IF_ERROR(DescribeLines(image, segments));
    const double described_ms = stopwatch.Milliseconds() - ms;
    std::printf(
        "segments: %6zu, %7.1f ms, %6.1f ms per megapixel; descriptors "
        "%.1f ms\n",
        segments.size(), ms, ms / megapixels, described_ms);
    features.segments = std::move(segments);
  }
  if (flags.draw.empty()) return 0;
  LOWLAP_RETURN_IF_ERROR(WriteOverlay(image, features, flags.draw));
  std::printf("written to %s\n", flags.draw.c_str());
  return 0;
}

}  // namespace

void AddFeatures(CLI::App* program, Action* action) {
  auto flags = std::make_shared<FeaturesFlags>();
  CLI::App* command = AddCommand(
      program, "features",
      "Detect the points and line segments of one image, count them, "
      "tell the time, and draw them");
  AddOption(command, "image", flags->image, "Image file").Required();
  AddOption(command, "--draw", flags->draw,
            "Write the image with its features as this PNG");
  AddFlag(command, "--points", flags->points, "Points only");
  AddFlag(command, "--lines", flags->lines, "Segments only");
  RunWhenChosen(command, flags, Features, action);
}

}  // namespace lowlap::cli
