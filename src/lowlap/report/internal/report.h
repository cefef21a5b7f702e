#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// What became of a pair of views.
struct ReportPair {
  ViewPair views;
  bool is_used = false;       // its relative pose is part of the solution
  std::string note;           // its geometry, or why it is not used
  int num_point_matches = 0;  // before the inliers were chosen
  int num_line_matches = 0;
  double log10_nfa = 0;
};

/// log10 NFA over the log ratios of a triplet, in total and by kind of
/// evidence; all lists have the length of `log_ratios`, which ascend.
struct ReportProfile {
  std::vector<double> log_ratios;
  std::vector<double> log10_nfas;
  std::vector<std::pair<std::string, std::vector<double>>> kinds;
};

/// A solution before its adjustment, with the ids of the scene.
struct ReportStage {
  std::map<PoseId, Pose> poses;
  std::map<PointTrackId, Vec3> points;
  std::map<LineTrackId, std::array<Vec3, 2>> lines;  // ends
};

/// True cameras in the frame of the scene, and how far it is from them.
struct ReportTruth {
  std::map<ViewId, Pose> poses;
  std::map<ViewId, double> position_errors;  // in the truth's unit
  std::map<ViewId, double> rotation_errors_deg;
};

struct ReportWarning {
  std::string text;
  std::vector<ViewId> views;  // concerned; may be empty
};

/// What the page shows beyond the scene; all of it may be missing.
struct ReportContent {
  std::string title;
  /// The headline figures: what, and its value.
  std::vector<std::pair<std::string, std::string>> figures;
  /// What a reader must not overlook (unplaced views, contradictions).
  std::vector<ReportWarning> warnings;
  /// What else there is to say.
  std::vector<std::string> notes;
  /// JPEG files of the photographs, small.
  std::map<ViewId, std::string> photographs;
  /// All features that were detected; the scene has those with a match.
  std::map<ViewId, ViewFeatures> detected;
  std::vector<ReportPair> pairs;
  std::map<ViewTriplet, ReportProfile> profiles;
  std::optional<ReportStage> before_adjustment;
  std::optional<ReportTruth> truth;
};

/// A page that needs nothing but a browser, to explore a solution: photographs
/// with their features, cameras and structure in space, the view graph, pairs,
/// ratios, residuals. The same input gives the same bytes.
///
/// Large scenes are thinned out evenly, and the page says so: see PageLimits.
std::string FormatReport(const Scene& scene, const ReportContent& content);

}  // namespace lowlap
