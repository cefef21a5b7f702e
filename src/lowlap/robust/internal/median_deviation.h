#pragma once

namespace lowlap {

/// The median of the norm of a vector of D independent normal errors, in their
/// standard deviations (the root of the median of chi squared): what the median
/// of residual norms is divided by for a robust deviation per axis. A norm has
/// one more for every dimension that can err: 1 for a log ratio or a distance
/// to a line, 2 for a direction or a pixel, 3 for a rotation.
template <int kDimension>
inline constexpr double kMedianOfNorm = 0;
template <>
inline constexpr double kMedianOfNorm<1> = 0.6744897502;
template <>
inline constexpr double kMedianOfNorm<2> = 1.1774100225;
template <>
inline constexpr double kMedianOfNorm<3> = 1.5381722545;

/// The same for the lower quartile, which less than three in four false
/// residuals do not move.
template <int kDimension>
inline constexpr double kLowerQuartileOfNorm = 0;
template <>
inline constexpr double kLowerQuartileOfNorm<1> = 0.3186393640;
template <>
inline constexpr double kLowerQuartileOfNorm<2> = 0.7585276164;
template <>
inline constexpr double kLowerQuartileOfNorm<3> = 1.1011507177;

}  // namespace lowlap
