#include "lowlap/averaging/internal/sparse_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

Matrix FromEntries(int size, const Entries& entries) {
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// The lower triangle of the Laplacian of a path with random weights between 1
// and 2, plus 1 on the diagonal; eigenvalues are between 1 and 9.
Matrix Path(int size, std::uint64_t seed) {
  Random random(seed);
  Entries entries;
  for (int n = 0; n < size; ++n) entries.emplace_back(n, n, 1.0);
  for (int n = 0; n + 1 < size; ++n) {
    const double weight = random.Uniform(1, 2);
    entries.emplace_back(n, n, weight);
    entries.emplace_back(n + 1, n + 1, weight);
    entries.emplace_back(n + 1, n, -weight);
  }
  return FromEntries(size, entries);
}

Eigen::MatrixXd RandomMatrix(int rows, int columns, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd matrix(rows, columns);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) matrix(r, c) = random.Uniform(-1, 1);
  }
  return matrix;
}

// I + 1 1^T / n, whose inverse is I - 1 1^T / (2 n). From 2000 rows on a dense
// factor is out of bounds.
Matrix Dense(int size) {
  Entries entries;
  for (int r = 0; r < size; ++r) {
    entries.emplace_back(r, r, 1.0);
    for (int c = 0; c <= r; ++c) entries.emplace_back(r, c, 1.0 / size);
  }
  return FromEntries(size, entries);
}

// Either side of the size from which CHOLMOD solves.
class SparseSolverOfSize : public ::testing::TestWithParam<int> {};

TEST_P(SparseSolverOfSize, SolvesForEveryColumn) {
  const Matrix lower = Path(GetParam(), 1);
  const Eigen::MatrixXd rhs = RandomMatrix(GetParam(), 3, 2);
  const auto x = SparseSolver().Solve(lower, rhs);
  ASSERT_TRUE(x) << x.error().message;
  // Condition 9 and rows of three entries: some units in the last place.
  EXPECT_LT((lower.selfadjointView<Eigen::Lower>() * *x - rhs)
                .lpNorm<Eigen::Infinity>(),
            1e-13);
}

TEST_P(SparseSolverOfSize, IgnoresWhatIsAboveTheDiagonal) {
  Matrix lower = Path(GetParam(), 3);
  const Eigen::MatrixXd rhs = RandomMatrix(GetParam(), 1, 4);
  const Eigen::MatrixXd x = *SparseSolver().Solve(lower, rhs);
  lower.coeffRef(0, 5) = 1e3;
  lower.coeffRef(GetParam() - 2, GetParam() - 1) = -1e3;
  lower.makeCompressed();
  EXPECT_LT((*SparseSolver().Solve(lower, rhs) - x).norm(), 1e-12);
}

TEST_P(SparseSolverOfSize, IsTheSameSolverForOtherValuesAndPatterns) {
  SparseSolver solver;
  const Eigen::MatrixXd rhs = RandomMatrix(GetParam(), 1, 5);
  Matrix other = Path(GetParam(), 7);
  other.coeffRef(GetParam() - 1, 0) = -0.5;
  other.makeCompressed();
  for (const Matrix& lower :
       {Path(GetParam(), 5), Path(GetParam(), 6), other, Path(30, 8)}) {
    const Eigen::MatrixXd b = rhs.topRows(lower.rows());
    const auto again = solver.Solve(lower, b);
    ASSERT_TRUE(again);
    EXPECT_EQ(*again, *SparseSolver().Solve(lower, b));
  }
}

TEST_P(SparseSolverOfSize, FactorizesOnceForManyRightHandSides) {
  SparseSolver solver;
  const Matrix lower = Path(GetParam(), 1);
  ASSERT_TRUE(solver.Factorize(lower));
  for (const int columns : {1, 3}) {
    const Eigen::MatrixXd rhs = RandomMatrix(GetParam(), columns, 14);
    EXPECT_EQ(*solver.Solve(rhs), *SparseSolver().Solve(lower, rhs));
  }
}

TEST_P(SparseSolverOfSize, RefusesWhatIsSingularOrNotFinite) {
  SparseSolver solver;
  Matrix lower = Path(GetParam(), 9);
  const Eigen::MatrixXd rhs = RandomMatrix(GetParam(), 1, 10);
  const Matrix regular = lower;
  // Unknown 7 is in no equation.
  lower.coeffRef(7, 6) = lower.coeffRef(7, 7) = lower.coeffRef(8, 7) = 0;
  auto x = solver.Solve(lower, rhs);
  ASSERT_FALSE(x);
  EXPECT_EQ(x.error().code, ErrorCode::kNumerical);
  EXPECT_NE(x.error().message.find(std::to_string(GetParam())),
            std::string::npos);
  lower = regular;
  lower.coeffRef(7, 7) = std::nan("");
  x = solver.Solve(lower, rhs);
  ASSERT_FALSE(x);
  EXPECT_EQ(x.error().code, ErrorCode::kNumerical);
  EXPECT_TRUE(solver.Solve(regular, rhs));
}

INSTANTIATE_TEST_SUITE_P(Sizes, SparseSolverOfSize,
                         ::testing::Values(100, 2500));

class HostThatCounts {
 public:
  explicit HostThatCounts(int stop_at = 0) {
    context_.progress = [this, stop_at](const std::string&, std::size_t,
                                        std::size_t) {
      return ++num_questions_ != stop_at;
    };
  }
  const RunContext& context() const { return context_; }
  int num_questions() const { return num_questions_; }

 private:
  RunContext context_;
  int num_questions_ = 0;
};

TEST(SparseSolver, GradientsSolveWhatFillsUp) {
  constexpr int kSize = 2100;
  const Eigen::MatrixXd rhs = RandomMatrix(kSize, 2, 11);
  HostThatCounts host;
  SparseSolver solver(host.context());
  const auto x = solver.Solve(Dense(kSize), rhs);
  ASSERT_TRUE(x) << x.error().message;
  ASSERT_GT(host.num_questions(), 0);
  for (int c = 0; c < 2; ++c) {
    const Eigen::VectorXd expected = rhs.col(c).array() - rhs.col(c).mean() / 2;
    // The inverse has the norm 1, the relative residual is 1e-6.
    EXPECT_LE((x->col(c) - expected).norm(), 1e-6 * rhs.col(c).norm());
  }
  // The last solution is where the next search begins.
  const int before = host.num_questions();
  const auto again = solver.Solve(Dense(kSize), rhs);
  ASSERT_TRUE(again);
  EXPECT_EQ(host.num_questions(), before);
  EXPECT_EQ(*again, *x);
  EXPECT_TRUE(
      solver.Solve(Dense(kSize), Eigen::MatrixXd::Zero(kSize, 1))->isZero());
}

TEST(SparseSolver, GradientsStopWhenTheyAreAskedTo) {
  HostThatCounts host(1);
  const auto stopped = SparseSolver(host.context())
                           .Solve(Dense(2100), RandomMatrix(2100, 2, 12));
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(host.num_questions(), 1);
}

TEST(SparseSolver, GradientsRefuseWhatTheyCannotReach) {
  Matrix lower = Dense(2100);
  lower.coeffRef(7, 7) = std::nan("");
  const auto x = SparseSolver().Solve(lower, RandomMatrix(2100, 1, 13));
  ASSERT_FALSE(x);
  EXPECT_EQ(x.error().code, ErrorCode::kNumerical);
}

}  // namespace
}  // namespace lowlap
