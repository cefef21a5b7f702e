#pragma once

#include "lowlap/io/internal/transfer.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

// The bytes of scale ratios in the binary form, as in scene_records.h.

inline constexpr std::size_t kKindSupportMinBytes = 8 + 3 * 4 + 3 * 8;

inline constexpr auto kTransferKindSupport = [](auto& archive, auto& support) {
  archive.Text(support.kind);
  archive.Count(support.candidates);
  archive.Count(support.inliers);
  archive.Real(support.log10_nfa);
  archive.Real(support.threshold_px);
  archive.Real(support.information_share);
  archive.Count(support.min_agreeing);
};

inline constexpr auto kTransferRatioMode = [](auto& archive, auto& mode) {
  archive.Real(mode.log_ratio);
  archive.Real(mode.log10_nfa);
};

inline constexpr auto kTransferCoplanarInlier = [](auto& archive,
                                                   auto& inlier) {
  archive.Integer(inlier.line_in_first);
  archive.Integer(inlier.line_in_last);
};

// What all versions begin with.
template <class Archive, class Ratio>
void TransferRatioHead(Archive& archive, Ratio& ratio) {
  archive.Integer(ratio.views.first);
  archive.Integer(ratio.views.middle);
  archive.Integer(ratio.views.last);
  TransferEnum(archive, ratio.verdict, RatioVerdict::kNoCandidates);
  archive.Real(ratio.log_ratio);
  archive.Real(ratio.log_ratio_stddev);
  archive.Real(ratio.log10_nfa);
}

inline constexpr std::size_t kScaleRatioMinBytes =
    12 + 1 + 3 * 8 + 1 + 8 + 4 + 8;

inline constexpr auto kTransferScaleRatio = [](auto& archive, auto& ratio) {
  TransferRatioHead(archive, ratio);
  TransferOptional(archive, ratio.second_mode, kTransferRatioMode);
  TransferVector(archive, ratio.kinds, kKindSupportMinBytes,
                 kTransferKindSupport);
  archive.Count(ratio.num_rejected_negative);
  TransferVector(archive, ratio.coplanar_inliers, 8, kTransferCoplanarInlier);
};

}  // namespace lowlap
