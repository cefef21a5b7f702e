#include "lowlap/synthetic/internal/observe.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "lowlap/core/internal/random.h"
#include "lowlap/synthetic/internal/wrong_match.h"

namespace lowlap {
namespace {

constexpr std::uint64_t kPointStream = 4'000'000'000;
constexpr std::uint64_t kLineStream = 5'000'000'000;

// The views of each track of a feature: those its matches connect, or the two
// of one pair where it may not be seen by more.
std::vector<std::vector<ViewId>> TrackViews(const PairGraph& graph,
                                            const std::vector<ViewId>& views,
                                            double trifocal_share,
                                            Random* random) {
  std::vector<std::vector<ViewId>> tracks = graph.Components(views);
  for (std::vector<ViewId>& track : tracks) {
    const bool may_be_trifocal = random->Uniform() < trifocal_share;
    if (may_be_trifocal || track.size() == 2) continue;
    const std::vector<ViewPair> pairs = graph.PairsAmong(track);
    const ViewPair kept =
        pairs[random->Index(static_cast<std::uint32_t>(pairs.size()))];
    track = {kept.first, kept.second};
  }
  return tracks;
}

template <class Image, class Shape>
Sightings<Image> RightSightings(const std::vector<Camera>& cameras,
                                const PairGraph& graph,
                                const std::vector<ViewId>& views,
                                const Shape& shape) {
  Sightings<Image> sightings;
  for (const ViewId view : views) {
    sightings.images[view] = *cameras[view.value()].Project(shape);
  }
  sightings.matches = graph.PairsAmong(views);
  return sightings;
}

// The track's features, by view, become its observations and matches.
Track AddMatches(const std::map<ViewId, std::vector<FeatureIndex>>& features,
                 const std::vector<ViewPair>& pairs,
                 std::vector<FeatureMatch> RelativePose::*matches,
                 Scene* scene) {
  Track track;
  for (const auto& [view, indices] : features) {
    for (const FeatureIndex index : indices) track.push_back({view, index});
  }
  for (const ViewPair& pair : pairs) {
    RelativePose& edge = scene->relative_poses.at(pair);
    for (const FeatureIndex first : features.at(pair.first)) {
      for (const FeatureIndex second : features.at(pair.second)) {
        (edge.*matches).push_back({first, second});
      }
    }
  }
  return track;
}

// The tracks of features that look the same, which `tracks` has by feature.
template <class Feature, class Id>
std::vector<AlikeTracks<Id>> TracksThatLookTheSame(
    const std::vector<Wall>& walls, const std::vector<Feature>& features,
    const std::vector<std::vector<Id>>& tracks) {
  struct Seen {
    Id track;
    Mat3 axes;
  };
  std::map<int, Seen> first_of;  // by the feature that the others are copies of
  std::vector<AlikeTracks<Id>> alike;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int original =
        features[i].alike >= 0 ? features[i].alike : static_cast<int>(i);
    const Mat3 axes = walls[features[i].wall].Axes();
    for (const Id track : tracks[i]) {
      const auto [it, is_first] =
          first_of.try_emplace(original, Seen{track, axes});
      if (is_first || features[i].alike < 0) continue;
      const Seen& first = it->second;
      alike.push_back({first.track, track, first.axes.transpose() * axes});
    }
  }
  return alike;
}

Vec2 Noisy(const Vec2& pixel, double noise_px, Random* random) {
  const double x = random->Gaussian(noise_px);
  const double y = random->Gaussian(noise_px);
  return pixel + Vec2(x, y);
}

// What a detector finds of a segment: not quite its length, perhaps broken.
std::vector<LineSegment> Detect(const Segment2& segment,
                                const SyntheticOptions& options,
                                Random* random) {
  const auto at = [&](double s) {
    return Vec2(segment.start + s * (segment.end - segment.start));
  };
  const double begin = random->Uniform(0.0, 0.1);
  const double end = random->Uniform(0.9, 1.0);
  const bool broken = random->Uniform() < options.broken_line_share;
  const double gap = random->Uniform(0.35, 0.65);
  std::vector<Segment2> pieces;
  if (broken) {
    pieces = {{at(begin), at(gap - 0.01)}, {at(gap + 0.01), at(end)}};
  } else {
    pieces = {{at(begin), at(end)}};
  }
  std::vector<LineSegment> detected;
  for (const Segment2& piece : pieces) {
    LineSegment line;
    line.start_px = Noisy(piece.start, options.noise_px, random);
    line.end_px = Noisy(piece.end, options.noise_px, random);
    if (options.noise_px > 0) line.stddev_px = options.noise_px;
    detected.push_back(line);
  }
  return detected;
}

}  // namespace

void ObservePoints(const SyntheticOptions& options, const World& world,
                   const std::vector<Camera>& cameras, const PairGraph& graph,
                   const std::vector<std::vector<ViewId>>& views_of_points,
                   SyntheticScene* synthetic) {
  Scene& scene = synthetic->scene;
  PointTrackId id = 0;
  std::vector<std::vector<PointTrackId>> tracks(world.points.size());
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    const Vec3& point = world.points[i].position;
    Random random(options.seed, kPointStream + i);
    for (const std::vector<ViewId>& views :
         TrackViews(graph, views_of_points[i], options.trifocal_point_share,
                    &random)) {
      const bool wrong = random.Uniform() < options.wrong_point_share;
      const Sightings<Vec2> sightings =
          wrong ? WrongSightings(options, cameras, graph, views, point, &random)
                : RightSightings<Vec2>(cameras, graph, views, point);
      if (sightings.images.size() < 2) continue;
      std::map<ViewId, std::vector<FeatureIndex>> features;
      for (const auto& [view, pixel] : sightings.images) {
        std::vector<Vec2>& points_px = scene.features[view].points_px;
        features[view] = {static_cast<FeatureIndex>(points_px.size())};
        points_px.push_back(Noisy(pixel, options.noise_px, &random));
      }
      scene.point_tracks[id] = AddMatches(features, sightings.matches,
                                          &RelativePose::point_inliers, &scene);
      if (!wrong) synthetic->true_points[id] = point;
      tracks[i].push_back(id);
      ++id;
    }
  }
  synthetic->alike_points =
      TracksThatLookTheSame(world.walls, world.points, tracks);
}

void ObserveLines(const SyntheticOptions& options, const World& world,
                  const std::vector<Camera>& cameras, const PairGraph& graph,
                  const std::vector<std::vector<ViewId>>& views_of_lines,
                  SyntheticScene* synthetic) {
  Scene& scene = synthetic->scene;
  LineTrackId id = 0;
  std::vector<std::vector<LineTrackId>> tracks(world.lines.size());
  for (std::size_t i = 0; i < world.lines.size(); ++i) {
    const WorldLine& line = world.lines[i];
    const Segment3 shape = {line.start, line.end};
    Random random(options.seed, kLineStream + i);
    for (const std::vector<ViewId>& views : TrackViews(
             graph, views_of_lines[i], options.trifocal_line_share, &random)) {
      const bool wrong = random.Uniform() < options.wrong_line_share;
      const Sightings<Segment2> sightings =
          wrong ? WrongSightings(options, cameras, graph, views, shape, &random)
                : RightSightings<Segment2>(cameras, graph, views, shape);
      if (sightings.images.size() < 2) continue;
      std::map<ViewId, std::vector<FeatureIndex>> features;
      for (const auto& [view, segment] : sightings.images) {
        std::vector<LineSegment>& segments = scene.features[view].segments;
        for (const LineSegment& detected : Detect(segment, options, &random)) {
          features[view].push_back(static_cast<FeatureIndex>(segments.size()));
          segments.push_back(detected);
        }
      }
      scene.line_tracks[id] = AddMatches(features, sightings.matches,
                                         &RelativePose::line_inliers, &scene);
      if (!wrong) {
        synthetic->true_lines[id] = {line.start, line.end, line.planes};
      }
      tracks[i].push_back(id);
      ++id;
    }
  }
  synthetic->alike_lines =
      TracksThatLookTheSame(world.walls, world.lines, tracks);
}

}  // namespace lowlap
