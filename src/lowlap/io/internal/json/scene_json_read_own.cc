#include "lowlap/io/internal/json/scene_json_sections.h"
#include "lowlap/io/internal/old_scale_ratios.h"
#include "lowlap/io/internal/scene_version.h"

namespace lowlap {
namespace {

// Calls `add(a, b)` for the pairs of a flat array of ids.
template <class Add>
void ReadIdPairs(const JsonValue& flat, const Add& add) {
  flat.FlatSize(2);
  std::uint32_t first = 0;
  bool is_second = false;
  for (const JsonValue element : flat.Elements()) {
    if (is_second) {
      add(first, element.Id());
    } else {
      first = element.Id();
    }
    is_second = !is_second;
  }
}

template <int kCount, class Add>
void ReadReals(const JsonValue& flat, const Add& add) {
  flat.FlatSize(kCount);
  double numbers[kCount];
  int n = 0;
  for (const JsonValue element : flat.Elements()) {
    numbers[n++] = element.Real();
    if (n < kCount) continue;
    add(numbers);
    n = 0;
  }
}

// Structs of two ids each.
template <class Pairs>
Pairs ReadPairs(const JsonValue& flat) {
  Pairs pairs;
  pairs.reserve(flat.FlatSize(2) / 2);
  ReadIdPairs(flat, [&](std::uint32_t first, std::uint32_t second) {
    pairs.push_back({first, second});
  });
  return pairs;
}

ViewFeatures ReadFeatures(const JsonValue& record) {
  record.AllowOnly({"view", "points", "point_covariances", "segments"});
  ViewFeatures features;
  const JsonValue points = record.At("points");
  features.points_px.reserve(points.FlatSize(2) / 2);
  ReadReals<2>(points, [&](const double* v) {
    features.points_px.emplace_back(v[0], v[1]);
  });
  if (const auto shapes = record.Find("point_covariances")) {
    features.point_covariances.reserve(shapes->FlatSize(3) / 3);
    ReadReals<3>(*shapes, [&](const double* v) {
      features.point_covariances.emplace_back(v[0], v[1], v[2]);
    });
  }
  const JsonValue segments = record.At("segments");
  features.segments.reserve(segments.FlatSize(5) / 5);
  ReadReals<5>(segments, [&](const double* v) {
    features.segments.push_back({{v[0], v[1]}, {v[2], v[3]}, v[4]});
  });
  return features;
}

ViewPair ReadViewPair(const JsonValue& value) {
  ViewPair views;
  if (value.FlatSize(1) != 2) value.Fail("must be two view ids");
  ReadIdPairs(value, [&](ViewId first, ViewId second) {
    views = {first, second};
  });
  return views;
}

void ReadMotion(const JsonValue& record, Mat3* rotation, Vec3* direction,
                double* log10_nfa,
                std::optional<Eigen::Matrix<double, 5, 5>>* covariance) {
  *rotation = record.At("rotation").Matrix<3, 3>();
  *direction = record.At("direction").Vector<3>();
  *log10_nfa = record.At("log10_nfa").Real();
  if (const auto found = record.Find("covariance")) {
    *covariance = found->Matrix<5, 5>();
  }
}

RelativePose ReadRelativePose(const JsonValue& record) {
  record.AllowOnly({"views", "rotation", "direction", "point_inliers",
                    "line_inliers", "log10_nfa", "point_threshold_px",
                    "covariance", "alternatives"});
  RelativePose edge;
  edge.views = ReadViewPair(record.At("views"));
  ReadMotion(record, &edge.rotation, &edge.direction, &edge.log10_nfa,
             &edge.covariance);
  edge.point_threshold_px = record.At("point_threshold_px").Real();
  edge.point_inliers =
      ReadPairs<std::vector<FeatureMatch>>(record.At("point_inliers"));
  edge.line_inliers =
      ReadPairs<std::vector<FeatureMatch>>(record.At("line_inliers"));
  if (const auto list = record.Find("alternatives")) {
    for (const JsonValue alternative : list->Elements()) {
      alternative.AllowOnly(
          {"rotation", "direction", "log10_nfa", "covariance"});
      AlternativeMotion& motion = edge.alternatives.emplace_back();
      ReadMotion(alternative, &motion.rotation, &motion.direction,
                 &motion.log10_nfa, &motion.covariance);
    }
  }
  return edge;
}

KindSupport ReadSupport(const JsonValue& record) {
  KindSupport support;
  support.candidates = record.At("candidates").Count();
  support.inliers = record.At("inliers").Count();
  support.log10_nfa = record.At("log10_nfa").Real();
  support.threshold_px = record.At("threshold_px").Real();
  if (const auto share = record.Find("information_share")) {
    support.information_share = share->Real();
  }
  return support;
}

void ReadKinds(const JsonValue& record, ScaleRatio* ratio) {
  record.AllowOnly({"views", "verdict", "log_ratio", "log_ratio_stddev",
                    "log10_nfa", "second_mode", "kinds",
                    "num_rejected_negative", "coplanar_inliers"});
  for (const JsonValue kind : record.At("kinds").Elements()) {
    kind.AllowOnly({"kind", "candidates", "inliers", "log10_nfa",
                    "threshold_px", "information_share", "min_agreeing"});
    KindSupport& support = ratio->kinds.emplace_back(ReadSupport(kind));
    support.kind = kind.At("kind").String();
    support.min_agreeing = kind.At("min_agreeing").Count();
  }
}

void ReadOldKinds(const JsonValue& record, ScaleRatio* ratio) {
  record.AllowOnly({"views", "verdict", "log_ratio", "log_ratio_stddev",
                    "log10_nfa", "second_mode", kOldKinds[0].name,
                    kOldKinds[1].name, kOldKinds[2].name,
                    "num_rejected_negative", "coplanar_inliers"});
  for (const OldKind& old : kOldKinds) {
    const JsonValue kind = record.At(old.name);
    kind.AllowOnly({"candidates", "inliers", "log10_nfa", "threshold_px",
                    "information_share"});
    KindSupport& support = ratio->kinds.emplace_back(ReadSupport(kind));
    support.kind = old.name;
    support.min_agreeing = old.min_agreeing;
  }
}

RatioVerdict ReadVerdict(const JsonValue& value) {
  for (const RatioVerdict verdict :
       {RatioVerdict::kMeaningful, RatioVerdict::kNotMeaningful,
        RatioVerdict::kNoCandidates}) {
    if (value.String() == RatioVerdictName(verdict)) return verdict;
  }
  value.Fail("verdict \"" + value.String() + "\" is not known");
}

ScaleRatio ReadScaleRatio(const JsonValue& record, std::uint32_t version) {
  ScaleRatio ratio;
  const JsonValue views = record.At("views");
  if (views.FlatSize(1) != 3) views.Fail("must be three view ids");
  auto view = views.Elements().begin();
  ratio.views.first = (*view).Id();
  ratio.views.middle = (*++view).Id();
  ratio.views.last = (*++view).Id();
  ratio.verdict = ReadVerdict(record.At("verdict"));
  ratio.log_ratio = record.At("log_ratio").Real();
  ratio.log_ratio_stddev = record.At("log_ratio_stddev").Real();
  ratio.log10_nfa = record.At("log10_nfa").Real();
  if (const auto mode = record.Find("second_mode")) {
    mode->AllowOnly({"log_ratio", "log10_nfa"});
    ratio.second_mode =
        RatioMode{mode->At("log_ratio").Real(), mode->At("log10_nfa").Real()};
  }
  version < kFirstVersionWithKinds ? ReadOldKinds(record, &ratio)
                                   : ReadKinds(record, &ratio);
  ratio.num_rejected_negative = record.At("num_rejected_negative").Count();
  ratio.coplanar_inliers =
      ReadPairs<std::vector<CoplanarInlier>>(record.At("coplanar_inliers"));
  return ratio;
}

Intrinsic ReadGivenIntrinsic(const JsonValue& record) {
  record.AllowOnly({"id", "model", "width", "height", "fx", "fy",
                    "principal_point", "distortion"});
  const JsonValue name = record.At("model");
  const std::optional<CameraModel> model = CameraModelFromName(name.String());
  if (!model) {
    name.Fail("camera model \"" + name.String() + "\" is not known",
              ErrorCode::kUnsupported);
  }
  Intrinsic intrinsic;
  intrinsic.model = *model;
  intrinsic.width_px = record.At("width").Count();
  intrinsic.height_px = record.At("height").Count();
  intrinsic.fx_px = record.At("fx").Real();
  intrinsic.fy_px = record.At("fy").Real();
  intrinsic.principal_point_px = record.At("principal_point").Vector<2>();
  const JsonValue distortion = record.At("distortion");
  for (const JsonValue coefficient : distortion.Elements()) {
    intrinsic.distortion.push_back(coefficient.Real());
  }
  return intrinsic;
}

LineLandmark ReadLine(const JsonValue& record) {
  record.AllowOnly(
      {"id", "direction", "moment", "start", "end", "observations"});
  LineLandmark landmark;
  landmark.line.direction = record.At("direction").Vector<3>();
  landmark.line.moment = record.At("moment").Vector<3>();
  landmark.start = record.At("start").Vector<3>();
  landmark.end = record.At("end").Vector<3>();
  landmark.observations = ReadPairs<Track>(record.At("observations"));
  return landmark;
}

// Calls `read(record)` for the records of a section; one that is missing is
// empty.
template <class Read>
void ReadSection(const JsonValue& own, std::string_view name,
                 const Read& read) {
  const auto list = own.Find(name);
  if (!list) return;
  for (const JsonValue record : list->Elements()) read(record);
}

}  // namespace

void ReadOwnSections(const JsonValue& own, Scene& scene) {
  const JsonValue version = own.At("version");
  if (version.Id() < kOldestSceneVersion || version.Id() > kSceneVersion) {
    version.Fail("version " + std::to_string(version.Id()) + " is not " +
                     std::to_string(kOldestSceneVersion) + " to " +
                     std::to_string(kSceneVersion),
                 ErrorCode::kUnsupported);
  }
  own.AllowOnly({"version", "given_intrinsics", "features", "relative_poses",
                 "point_tracks", "line_tracks", "scale_ratios",
                 "line_structure", "coplanar_pairs"});
  ReadSection(own, "given_intrinsics", [&](const JsonValue& record) {
    Insert(scene.given_intrinsics, record.At("id"), ReadGivenIntrinsic(record));
  });
  ReadSection(own, "features", [&](const JsonValue& record) {
    Insert(scene.features, record.At("view"), ReadFeatures(record), "view");
  });
  ReadSection(own, "relative_poses", [&](const JsonValue& record) {
    RelativePose edge = ReadRelativePose(record);
    const ViewPair views = edge.views;
    if (!scene.relative_poses.emplace(views, std::move(edge)).second) {
      record.Fail("the pair of views is repeated", ErrorCode::kInvalidScene);
    }
  });
  const auto read_track = [](const JsonValue& record, auto& tracks) {
    record.AllowOnly({"id", "observations"});
    Insert(tracks, record.At("id"),
           ReadPairs<Track>(record.At("observations")));
  };
  ReadSection(own, "point_tracks", [&](const JsonValue& record) {
    read_track(record, scene.point_tracks);
  });
  ReadSection(own, "line_tracks", [&](const JsonValue& record) {
    read_track(record, scene.line_tracks);
  });
  ReadSection(own, "scale_ratios", [&](const JsonValue& record) {
    scene.scale_ratios.push_back(ReadScaleRatio(record, version.Id()));
  });
  ReadSection(own, "line_structure", [&](const JsonValue& record) {
    Insert(scene.line_structure, record.At("id"), ReadLine(record));
  });
  if (const auto pairs = own.Find("coplanar_pairs")) {
    scene.coplanar_pairs = ReadPairs<std::vector<CoplanarPair>>(*pairs);
  }
}

}  // namespace lowlap
