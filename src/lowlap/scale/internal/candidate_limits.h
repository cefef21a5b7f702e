#pragma once

namespace lowlap {

/// A point or line with a larger standard deviation of log tau is hopeless.
inline constexpr double kMaxLogRatioStddev = 1.0;
/// The same for a coplanar pair. Most pairs are not coplanar, and those that
/// say little agree with any ratio, so that they drown the others: on simulated
/// rooms the NFA falls as this limit is lowered from 1 to 0.05.
inline constexpr double kMaxPlaneLogRatioStddev = 0.05;

}  // namespace lowlap
