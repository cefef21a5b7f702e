#include "lowlap/averaging/internal/block_matrix.h"

#include <gtest/gtest.h>

#include <vector>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using Place = BlockMatrix::Place;

Mat3 RandomBlock(Random* random) {
  Mat3 block;
  for (int n = 0; n < 3; ++n) block.col(n) = RandomVector(random, 1);
  return block;
}

// Out of order, with repetitions, and with diagonal blocks among them.
const std::vector<Place> kPlaces = {{4, 1}, {3, 3}, {2, 0}, {4, 1},
                                    {4, 3}, {1, 0}, {4, 0}, {2, 0}};

TEST(BlockMatrix, SumsUpLikeADenseMatrix) {
  BlockMatrix matrix(5, kPlaces);
  ASSERT_EQ(matrix.lower().rows(), 15);
  ASSERT_EQ(matrix.lower().cols(), 15);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(15, 15);
  Random random(1);
  for (int round = 0; round < 3; ++round) {
    std::vector<Place> places = kPlaces;
    for (std::size_t n = 0; n < 5; ++n) places.push_back({n, n});
    for (const auto& [row, column] : places) {
      const Mat3 block = RandomBlock(&random);
      matrix.Add(matrix.FindBlock(row, column), block);
      dense.block<3, 3>(3 * row, 3 * column) += block;
    }
  }
  // Of diagonal blocks, only the lower triangle.
  dense = dense.triangularView<Eigen::Lower>();
  EXPECT_EQ(Eigen::MatrixXd(matrix.lower()), dense);
}

TEST(BlockMatrix, HoldsThePatternAndNothingElse) {
  const BlockMatrix matrix(5, kPlaces);
  // Five diagonal blocks of six entries, five others of nine.
  EXPECT_EQ(matrix.lower().nonZeros(), 5 * 6 + 5 * 9);
  for (int column = 0; column < 15; ++column) {
    Eigen::Index last = -1;
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix.lower(), column);
         it; ++it) {
      EXPECT_GE(it.row(), column);
      EXPECT_GT(it.row(), last);  // sorted, as solvers want it
      last = it.row();
      EXPECT_EQ(it.value(), 0);
    }
  }
}

TEST(BlockMatrix, BeginsAgainWithTheSamePattern) {
  BlockMatrix matrix(5, kPlaces);
  const std::size_t block = matrix.FindBlock(4, 1);
  matrix.Add(block, Mat3::Ones());
  matrix.Add(matrix.FindBlock(2, 2), Mat3::Ones());
  const Eigen::Index entries = matrix.lower().nonZeros();
  matrix.SetZero();
  EXPECT_EQ(matrix.lower().nonZeros(), entries);
  EXPECT_EQ(Eigen::MatrixXd(matrix.lower()), Eigen::MatrixXd::Zero(15, 15));
  EXPECT_EQ(matrix.FindBlock(4, 1), block);
}

TEST(BlockMatrix, MayHaveNoBlocksOrNoneBesideTheDiagonal) {
  EXPECT_EQ(BlockMatrix(0, {}).lower().rows(), 0);
  BlockMatrix diagonal(2, {});
  diagonal.Add(diagonal.FindBlock(1, 1), 2 * Mat3::Identity());
  EXPECT_EQ(diagonal.lower().nonZeros(), 12);
  EXPECT_EQ(diagonal.lower().coeff(5, 5), 2);
  EXPECT_EQ(diagonal.lower().coeff(2, 2), 0);
}

}  // namespace
}  // namespace lowlap
