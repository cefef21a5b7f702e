#pragma once

#include <cmath>
#include <initializer_list>
#include <string>

#include "lowlap/core/result.h"

namespace lowlap {

/// What options must satisfy, and what is said of those that do not.
struct Requirement {
  bool holds = false;
  std::string message;
};

/// kInvalidArgument with the message of the first that does not hold.
inline Status Require(std::initializer_list<Requirement> requirements) {
  for (const Requirement& requirement : requirements) {
    if (!requirement.holds) {
      return MakeError(ErrorCode::kInvalidArgument, requirement.message);
    }
  }
  return {};
}

inline bool IsPositive(double value) {
  return value > 0 && std::isfinite(value);
}

struct NamedNumber {
  double value = 0;
  std::string name;
};

/// The same of numbers that must be finite and not negative.
inline Status RequireNotNegative(std::initializer_list<NamedNumber> numbers) {
  for (const NamedNumber& number : numbers) {
    if (!(number.value >= 0 && std::isfinite(number.value))) {
      return MakeError(ErrorCode::kInvalidArgument,
                       number.name + " must be finite and not negative");
    }
  }
  return {};
}

}  // namespace lowlap
