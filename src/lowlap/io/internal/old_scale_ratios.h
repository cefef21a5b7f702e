#pragma once

#include <array>
#include <vector>

#include "lowlap/io/internal/byte_archive.h"
#include "lowlap/io/internal/scale_ratio_records.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

// Scale ratios before version 4 of the format, which had three fixed kinds of
// evidence.

struct OldKind {
  const char* name;
  int min_agreeing;
};
inline constexpr std::array<OldKind, 3> kOldKinds = {
    OldKind{"points", 2}, OldKind{"lines", 2}, OldKind{"coplanar", 3}};

/// The record of the section "RATI" of versions 2 and 3.
inline void ReadOldScaleRatio(ByteReader& archive, ScaleRatio& ratio) {
  TransferRatioHead(archive, ratio);
  for (const OldKind& old : kOldKinds) {
    KindSupport& support = ratio.kinds.emplace_back();
    support.kind = old.name;
    support.min_agreeing = old.min_agreeing;
    archive.Count(support.candidates);
    archive.Count(support.inliers);
    archive.Real(support.log10_nfa);
    archive.Real(support.threshold_px);
  }
  archive.Count(ratio.num_rejected_negative);
  TransferVector(archive, ratio.coplanar_inliers, 8, kTransferCoplanarInlier);
}

inline void ReadOldScaleRatios(ByteReader& archive,
                               std::vector<ScaleRatio>& ratios) {
  TransferVector(archive, ratios, 12 + 1 + 3 * 8 + 3 * 24 + 4 + 8,
                 ReadOldScaleRatio);
}

/// The section "RATD" of version 3: the number of scale ratios again, then the
/// second mode and the shares of information of each.
inline void ReadOldRatioDetails(ByteReader& archive,
                                std::vector<ScaleRatio>& ratios) {
  if (archive.Length(ratios.size(), 1 + 3 * 8) != ratios.size()) {
    archive.Fail("there are not as many details as scale ratios");
  }
  for (ScaleRatio& ratio : ratios) {
    TransferOptional(archive, ratio.second_mode, kTransferRatioMode);
    for (KindSupport& support : ratio.kinds) {
      archive.Real(support.information_share);
    }
  }
}

}  // namespace lowlap
