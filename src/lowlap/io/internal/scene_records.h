#pragma once

#include "lowlap/io/internal/record_traits.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

// The records of sfm_data/FORMAT.md that both forms have, each described once:
// a visitor hands its members in their order to a BinaryRecord, or to the
// json records (json_record_writer.h, json_record_reader.h), for writing (from
// const data) or for reading.

inline constexpr auto kVisitPair = [](auto& record, auto& pair) {
  record.Item(pair.first);
  record.Item(pair.second);
};

inline constexpr auto kVisitIntrinsic = [](auto& record, auto& intrinsic) {
  record.Member("model", intrinsic.model);
  record.Member("width", intrinsic.width_px);
  record.Member("height", intrinsic.height_px);
  record.Member("fx", intrinsic.fx_px);
  record.Member("fy", intrinsic.fy_px);
  record.Member("principal_point", intrinsic.principal_point_px);
  record.Member("distortion", intrinsic.distortion);
};

inline constexpr auto kVisitCenterCovariance = [](auto& record,
                                                  auto& covariance) {
  record.Member("covariance", covariance);
};

inline constexpr auto kVisitRepeated = [](auto& record, auto& features) {
  record.Flat("repeated_points", features.repeated_points, VisitItem(),
              Presence::kMayBeMissing);
  record.Flat("repeated_segments", features.repeated_segments, VisitItem(),
              Presence::kMayBeMissing);
};

inline constexpr auto kVisitFeatures = [](auto& record, auto& features) {
  record.Flat("points", features.points_px, VisitItem());
  record.Flat("point_covariances", features.point_covariances, VisitItem(),
              Presence::kMayBeMissing);
  record.Flat("segments", features.segments, [](auto& flat, auto& segment) {
    flat.Item(segment.start_px);
    flat.Item(segment.end_px);
    flat.Item(segment.stddev_px);
  });
  // A section of its own in the binary form.
  if (std::decay_t<decltype(record)>::kIsText) kVisitRepeated(record, features);
};

inline constexpr auto kVisitAlternative = [](auto& record, auto& motion) {
  record.Member("rotation", motion.rotation);
  record.Member("direction", motion.direction);
  record.Member("log10_nfa", motion.log10_nfa);
  record.Optional("covariance", motion.covariance);
};

inline constexpr auto kVisitRelativePose = [](auto& record, auto& edge) {
  constexpr bool kIsText = std::decay_t<decltype(record)>::kIsText;
  record.Member("views", edge.views);
  record.Member("rotation", edge.rotation);
  record.Member("direction", edge.direction);
  record.Member("log10_nfa", edge.log10_nfa);
  if (kIsText) record.Optional("covariance", edge.covariance);
  record.Member("point_threshold_px", edge.point_threshold_px);
  if (!kIsText) record.Optional("covariance", edge.covariance);
  record.Flat("point_inliers", edge.point_inliers, kVisitPair);
  record.Flat("line_inliers", edge.line_inliers, kVisitPair);
  record.List("alternatives", edge.alternatives, kVisitAlternative,
              Presence::kMayBeMissing);
  // A section of its own in the binary form.
  if (kIsText) record.Optional("weakness", edge.weakness);
};

inline constexpr auto kVisitTrack = [](auto& record, auto& track) {
  record.Flat("observations", track, [](auto& flat, auto& ref) {
    flat.Item(ref.view);
    flat.Item(ref.feature);
  });
};

inline constexpr auto kVisitLine = [](auto& record, auto& landmark) {
  record.Member("direction", landmark.line.direction);
  record.Member("moment", landmark.line.moment);
  record.Member("start", landmark.start);
  record.Member("end", landmark.end);
  kVisitTrack(record, landmark.observations);
};

inline constexpr auto kVisitRatioMode = [](auto& record, auto& mode) {
  record.Member("log_ratio", mode.log_ratio);
  record.Member("log10_nfa", mode.log10_nfa);
};

inline constexpr auto kVisitCoplanarInlier = [](auto& record, auto& inlier) {
  record.Item(inlier.line_in_first);
  record.Item(inlier.line_in_last);
};

inline constexpr auto kVisitKindCounts = [](auto& record, auto& support) {
  record.Member("candidates", support.candidates);
  record.Member("inliers", support.inliers);
  record.Member("log10_nfa", support.log10_nfa);
  record.Member("threshold_px", support.threshold_px);
};

// What all versions begin with, and end with.
inline constexpr auto kVisitRatioHead = [](auto& record, auto& ratio) {
  record.Member("views", ratio.views);
  record.Member("verdict", ratio.verdict);
  record.Member("log_ratio", ratio.log_ratio);
  record.Member("log_ratio_stddev", ratio.log_ratio_stddev);
  record.Member("log10_nfa", ratio.log10_nfa);
};
inline constexpr auto kVisitRatioTail = [](auto& record, auto& ratio) {
  record.Member("num_rejected_negative", ratio.num_rejected_negative);
  record.Flat("coplanar_inliers", ratio.coplanar_inliers, kVisitCoplanarInlier);
};

inline constexpr auto kVisitScaleRatio = [](auto& record, auto& ratio) {
  kVisitRatioHead(record, ratio);
  record.Optional("second_mode", ratio.second_mode, kVisitRatioMode);
  record.List("kinds", ratio.kinds, [](auto& kind, auto& support) {
    kind.Member("kind", support.kind);
    kVisitKindCounts(kind, support);
    kind.Member("information_share", support.information_share,
                Presence::kMayBeMissing);
    kind.Member("min_agreeing", support.min_agreeing);
  });
  kVisitRatioTail(record, ratio);
};

/// For reading only: before version 4 there were three fixed kinds of evidence,
/// and second modes and shares had a section of their own in the binary form.
inline constexpr auto kVisitOldScaleRatio = [](auto& record,
                                               ScaleRatio& ratio) {
  constexpr bool kIsText = std::decay_t<decltype(record)>::kIsText;
  struct OldKind {
    const char* name;
    int min_agreeing;
  };
  kVisitRatioHead(record, ratio);
  if constexpr (kIsText) {
    record.Optional("second_mode", ratio.second_mode, kVisitRatioMode);
  }
  for (const OldKind& old :
       {OldKind{"points", 2}, OldKind{"lines", 2}, OldKind{"coplanar", 3}}) {
    KindSupport& support = ratio.kinds.emplace_back();
    support.kind = old.name;
    support.min_agreeing = old.min_agreeing;
    if constexpr (kIsText) {
      record.Object(old.name, support, [](auto& kind, auto& counts) {
        kVisitKindCounts(kind, counts);
        kind.Member("information_share", counts.information_share,
                    Presence::kMayBeMissing);
      });
    } else {
      kVisitKindCounts(record, support);
    }
  }
  kVisitRatioTail(record, ratio);
};

}  // namespace lowlap
