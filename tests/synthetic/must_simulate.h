#pragma once

#include <gtest/gtest.h>

#include <utility>

#include "lowlap/synthetic/synthetic_scene.h"
#include "support/matchers.h"

namespace lowlap::testing {

/// A scene of options that are valid.
inline SyntheticScene MustSimulate(const SyntheticOptions& options) {
  Result<SyntheticScene> scene = Simulate(options);
  EXPECT_THAT(scene, IsOk());
  return std::move(scene).value();
}

}  // namespace lowlap::testing
