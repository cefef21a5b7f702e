#include "lowlap/geometry/similarity.h"

#include <gtest/gtest.h>

#include "geometry/random_geometry.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::RandomRotation;
using testing::RandomVector;
using testing::VectorNear;

Similarity RandomSimilarity(Random& random) {
  return {random.Uniform(0.01, 50), RandomRotation(random),
          100 * RandomVector(random)};
}

double SquaredError(const Similarity& similarity,
                    const std::vector<Vec3>& source,
                    const std::vector<Vec3>& target) {
  double sum = 0;
  for (std::size_t n = 0; n < source.size(); ++n) {
    sum += (target[n] - similarity * source[n]).squaredNorm();
  }
  return sum;
}

std::vector<Vec3> Moved(const Similarity& similarity,
                        const std::vector<Vec3>& points) {
  std::vector<Vec3> moved;
  for (const Vec3& point : points) moved.push_back(similarity * point);
  return moved;
}

TEST(Similarity, InverseInverts) {
  Random random(1);
  const Similarity similarity = RandomSimilarity(random);
  const Vec3 x = RandomVector(random);
  EXPECT_THAT(similarity.Inverse() * (similarity * x), VectorNear(x, 1e-11));
}

TEST(AlignPoints, RecoversTheSimilarityExactly) {
  Random random(2);
  for (int count : {3, 4, 10, 100}) {
    for (int n = 0; n < 20; ++n) {
      const Similarity truth = RandomSimilarity(random);
      std::vector<Vec3> source(count);
      for (Vec3& point : source) point = RandomVector(random);
      const auto found = AlignPoints(source, Moved(truth, source));
      ASSERT_THAT(found, IsOk());
      EXPECT_NEAR(found->scale, truth.scale, 1e-10 * truth.scale);
      EXPECT_LT((found->rotation - truth.rotation).norm(), 1e-6);
      EXPECT_THAT(found->translation, VectorNear(truth.translation, 1e-9));
    }
  }
}

TEST(AlignPoints, CoplanarPointsAreEnough) {
  Random random(3);
  std::vector<Vec3> source(6);
  for (Vec3& p : source) p = {random.Gaussian(), random.Gaussian(), 0};
  const Similarity truth = RandomSimilarity(random);
  const auto found = AlignPoints(source, Moved(truth, source));
  ASSERT_THAT(found, IsOk());
  EXPECT_LT((found->rotation - truth.rotation).norm(), 1e-9);
}

TEST(AlignPoints, NoNeighbourIsBetterUnderNoise) {
  Random random(4);
  for (int n = 0; n < 20; ++n) {
    const Similarity truth = RandomSimilarity(random);
    std::vector<Vec3> source(8), target;
    for (Vec3& point : source) point = RandomVector(random);
    target = Moved(truth, source);
    for (Vec3& point : target)
      point += 0.1 * truth.scale * RandomVector(random);
    const auto found = AlignPoints(source, target);
    ASSERT_THAT(found, IsOk());
    const double least = SquaredError(*found, source, target);
    for (int k = 0; k < 100; ++k) {
      Similarity other = *found;
      const double step = k % 2 ? 1e-2 : 1e-4;
      other.scale *= 1 + step * random.Gaussian();
      other.rotation =
          RotationFromAngleAxis(step * RandomVector(random)) * other.rotation;
      other.translation += step * truth.scale * RandomVector(random);
      EXPECT_GE(SquaredError(other, source, target), least * (1 - 1e-12));
    }
  }
}

// The best rotation is not the best orthogonal matrix here.
TEST(AlignPoints, MirroredPointsAreNotMirroredBack) {
  Random random(5);
  std::vector<Vec3> source(10), target;
  for (Vec3& point : source) point = RandomVector(random);
  for (const Vec3& p : source) target.emplace_back(-p.x(), p.y(), p.z());
  const auto found = AlignPoints(source, target);
  ASSERT_THAT(found, IsOk());
  EXPECT_LT(RotationDefect(found->rotation), 1e-12);
  EXPECT_GT(found->scale, 0);
  EXPECT_GT(SquaredError(*found, source, target), 0.1);
}

TEST(AlignPoints, TwoPointsTurnTheShortWay) {
  const std::vector<Vec3> source = {{0, 0, 0}, {1, 0, 0}};
  const std::vector<Vec3> target = {{5, 5, 5}, {5, 8, 5}};
  const auto found = AlignPoints(source, target);
  ASSERT_THAT(found, IsOk());
  EXPECT_NEAR(found->scale, 3, 1e-12);
  EXPECT_LT(SquaredError(*found, source, target), 1e-20);
  EXPECT_NEAR(AngleAxisFromRotation(found->rotation).norm(), kPi / 2, 1e-9);
}

TEST(AlignPoints, CollinearPointsTurnTheShortWay) {
  Random random(6);
  for (int n = 0; n < 50; ++n) {
    const Vec3 direction = RandomVector(random);
    std::vector<Vec3> source;
    for (const double s : {0.0, 1.0, 2.5, -3.0}) {
      source.push_back(Vec3(1, 2, 3) + s * direction);
    }
    const Similarity truth = RandomSimilarity(random);
    const auto found = AlignPoints(source, Moved(truth, source));
    ASSERT_THAT(found, IsOk());
    EXPECT_NEAR(found->scale, truth.scale, 1e-9 * truth.scale);
    EXPECT_LT(SquaredError(*found, source, Moved(truth, source)),
              1e-18 * truth.scale * truth.scale);
    EXPECT_NEAR(AngleAxisFromRotation(found->rotation).norm(),
                AngleBetween(direction, truth.rotation * direction), 1e-6);
  }
}

TEST(AlignPoints, OppositeCollinearPoints) {
  const std::vector<Vec3> source = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  const std::vector<Vec3> target = {{0, 0, 0}, {-1, -2, -3}, {-2, -4, -6}};
  const auto found = AlignPoints(source, target);
  ASSERT_THAT(found, IsOk());
  EXPECT_LT(SquaredError(*found, source, target), 1e-18);
  EXPECT_LT(RotationDefect(found->rotation), 1e-12);
}

// Centres in a geographic frame: far from the origin, close to each other.
TEST(AlignPoints, FarFromTheOrigin) {
  Random random(7);
  std::vector<Vec3> source(5), target;
  for (Vec3& point : source) point = Vec3(4e6, 5e5, 3e6) + RandomVector(random);
  for (const Vec3& point : source) target.push_back(2 * point);
  const auto found = AlignPoints(source, target);
  ASSERT_THAT(found, IsOk());
  EXPECT_NEAR(found->scale, 2, 1e-6);
  EXPECT_LT(SquaredError(*found, source, target), 1e-10);
}

TEST(AlignPoints, Refuses) {
  const Vec3 p(1, 2, 3);
  EXPECT_THAT(AlignPoints({p, p}, {p}),
              IsError(ErrorCode::kInvalidArgument, "as many"));
  EXPECT_THAT(AlignPoints({p}, {p}),
              IsError(ErrorCode::kInsufficientData, "at least 2"));
  EXPECT_THAT(AlignPoints({p, p, p}, {p, 2 * p, 3 * p}),
              IsError(ErrorCode::kInsufficientData, "coincide"));
  EXPECT_THAT(AlignPoints({p, 2 * p, 3 * p}, {p, p, p}),
              IsError(ErrorCode::kInsufficientData, "coincide"));
}

}  // namespace
}  // namespace lowlap
