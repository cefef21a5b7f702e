#pragma once

#include <cstddef>

namespace lowlap {

/// The m-th of `num` > 0 ranks among `count`, evenly spaced; several are the
/// same where there are more of them. Read from the other end they are the
/// ranks among what is sorted the other way round (but for the middle one of an
/// odd number among an even one).
constexpr std::size_t EvenRank(std::size_t m, std::size_t num,
                               std::size_t count) {
  const auto rank = [=](std::size_t n) {
    return (2 * n + 1) * count / (2 * num);
  };
  const std::size_t mirrored = num - 1 - m;
  return m <= mirrored ? rank(m) : count - 1 - rank(mirrored);
}

}  // namespace lowlap
