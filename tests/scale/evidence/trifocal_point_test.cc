#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lowlap/geometry/internal/triangulation.h"
#include "lowlap/scale/evidence/internal/trifocal.h"
#include "scale/rig.h"

namespace lowlap {
namespace {

using testing::Gather;
using testing::NoisyTriplet;
using testing::Project;
using testing::Scaled;
using testing::SyntheticTriplet;

TEST(TrifocalPoints, ErrorsAreMeanReprojectionDistances) {
  const SyntheticTriplet triplet = NoisyTriplet();
  const TripletGeometry& g = triplet.view.geometry;
  const auto evidence = TrifocalPointKind().Gather(triplet.view);
  ASSERT_EQ(evidence->size(), static_cast<int>(triplet.view.points.size()));
  for (const double off : {0.0, 0.05, -0.4}) {
    const double log_ratio = triplet.true_log_ratio + off;
    std::vector<float> errors_px(evidence->size());
    evidence->Errors(std::exp(log_ratio), evidence->size(), errors_px.data());
    const RigidTransform k_from_j =
        Scaled(g.camk_from_camj, std::exp(log_ratio));
    for (int n = 0; n < evidence->size(); ++n) {
      const TripletPoint& point = triplet.view.points[n];
      const Vec3 from_i =
          *TriangulateMidpoint(g.cami_from_camj, point.in_j, point.in_i);
      const Vec3 from_k =
          *TriangulateMidpoint(k_from_j, point.in_j, point.in_k);
      const double expected =
          450.0 *
          ((Project(k_from_j * from_i) - Project(point.in_k)).norm() +
           (Project(g.cami_from_camj * from_k) - Project(point.in_i)).norm());
      EXPECT_NEAR(errors_px[n], expected, 0.01 + 1e-4 * expected);
    }
  }
}

}  // namespace
}  // namespace lowlap
