#pragma once

#include "lowlap/io/internal/transfer.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

// The bytes of scale ratios in the binary form, as in scene_records.h.

inline constexpr auto kTransferSupport = [](auto& archive, auto& support) {
  archive.Count(support.candidates);
  archive.Count(support.inliers);
  archive.Real(support.log10_nfa);
  archive.Real(support.threshold_px);
};

inline constexpr std::size_t kScaleRatioMinBytes =
    12 + 1 + 3 * 8 + 3 * 24 + 4 + 8;

inline constexpr auto kTransferScaleRatio = [](auto& archive, auto& ratio) {
  archive.Integer(ratio.views.first);
  archive.Integer(ratio.views.middle);
  archive.Integer(ratio.views.last);
  TransferEnum(archive, ratio.verdict, RatioVerdict::kNoCandidates);
  archive.Real(ratio.log_ratio);
  archive.Real(ratio.log_ratio_stddev);
  archive.Real(ratio.log10_nfa);
  kTransferSupport(archive, ratio.points);
  kTransferSupport(archive, ratio.lines);
  kTransferSupport(archive, ratio.coplanar);
  archive.Count(ratio.num_rejected_negative);
  TransferVector(archive, ratio.coplanar_inliers, 8, [](auto& a, auto& inlier) {
    a.Integer(inlier.line_in_first);
    a.Integer(inlier.line_in_last);
  });
};

// What version 3 added to the scale ratios, a section of its own.
inline constexpr std::size_t kRatioDetailsMinBytes = 1 + 3 * 8;

inline constexpr auto kTransferRatioDetails = [](auto& archive, auto& ratio) {
  TransferOptional(archive, ratio.second_mode, [](auto& a, auto& mode) {
    a.Real(mode.log_ratio);
    a.Real(mode.log10_nfa);
  });
  archive.Real(ratio.points.information_share);
  archive.Real(ratio.lines.information_share);
  archive.Real(ratio.coplanar.information_share);
};

/// The number of scale ratios again, then the details of each.
template <class Archive, class Ratios>
void TransferRatioDetails(Archive& archive, Ratios& ratios) {
  if (archive.Length(ratios.size(), kRatioDetailsMinBytes) != ratios.size()) {
    if constexpr (Archive::kReads) {
      archive.Fail("there are not as many details as scale ratios");
    }
  }
  for (auto& ratio : ratios) kTransferRatioDetails(archive, ratio);
}

}  // namespace lowlap
