#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lowlap/features/internal/features.h"
#include "lowlap/features/internal/points/tilted_points.h"
#include "lowlap/matching/internal/matching.h"

namespace lowlap {

// Bytes of cache entries: every number with all its bits, in the machine's own
// order, without padding. Reading returns nullopt unless the bytes are exactly
// those of one record.

std::string ToBytes(const DetectedFeatures& features);
std::optional<DetectedFeatures> FeaturesFromBytes(std::string_view bytes);

std::string ToBytes(const TiltedPoints& points);
std::optional<TiltedPoints> TiltedPointsFromBytes(std::string_view bytes);

std::string ToBytes(const PairMatches& matches);
std::optional<PairMatches> MatchesFromBytes(std::string_view bytes);

}  // namespace lowlap
