#pragma once

#include <set>
#include <string>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Writes the image as a PNG, faded, with its points as dots and its segments
/// as lines: each in a colour of its own, so that pieces of a broken edge can
/// be told apart, with a dot at its end (the direction is the polarity).
/// Errors: kIo, with the path.
Status WriteOverlay(const GrayImage& image, const ViewFeatures& features,
                    const std::string& path);

/// A PNG of the image, faded and at most so wide, with its features: those in
/// `inlier_points` and `inlier_segments` bright (green, orange), the others
/// pale.
Result<std::string> DrawInliers(const GrayImage& image,
                                const ViewFeatures& features,
                                const std::set<FeatureIndex>& inlier_points,
                                const std::set<FeatureIndex>& inlier_segments,
                                int max_width_px);

/// What DrawMatches shows of one of its two views.
struct MatchedView {
  const GrayImage* image = nullptr;
  const ViewFeatures* features = nullptr;
};

/// A PNG of two images side by side, faded and each at most so wide, with their
/// matches: both ends in the colour of the match, joined by a line. Matches of
/// features that a view does not have are left out.
Result<std::string> DrawMatches(const MatchedView& first,
                                const MatchedView& second,
                                const std::vector<FeatureMatch>& point_matches,
                                const std::vector<FeatureMatch>& line_matches,
                                int max_width_px);

}  // namespace lowlap
