#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/report/internal/table_text.h"
#include "lowlap/study/internal/trust/study.h"

namespace lowlap {

/// Cameras of some scenes, by how they came out.
struct TrustCounts {
  int scenes = 0;
  int cameras = 0;
  int placed = 0;
  int firm = 0;
  /// Firm, and off by more than kGoodCamera and five deviations.
  int firm_off = 0;
  int wrong = 0;   // off by more than kWrongCamera
  int silent = 0;  // of these, firm
  int good = 0;    // off by no more than kGoodCamera
  int good_doubted = 0;
};

/// Of the trials whose scene has the label; empty: of all of the family.
TrustCounts CountTrust(const TrustStudy& study, TrustFamily family,
                       const std::string& label = "");

/// A row for each family with truth and each label of its scenes.
TextTable TrustTable(const TrustStudy& study);

/// Counts by family, label and reason, the wrong cameras that are firm by seed,
/// and what the noise made.
std::string SummaryText(const TrustStudy& study);

/// The share of cameras graded firm against their error, with how many there
/// are, as SVG.
Result<std::string> DrawFirmShare(const TrustStudy& study);

/// What a complete study leaves, as (file name, content): cameras.csv,
/// summary.txt, firm_share.svg.
Result<std::vector<std::pair<std::string, std::string>>> TrustFiles(
    const TrustStudy& study);

}  // namespace lowlap
