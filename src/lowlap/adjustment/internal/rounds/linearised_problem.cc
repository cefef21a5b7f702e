#include "lowlap/adjustment/internal/rounds/linearised_problem.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace lowlap {
namespace {

using MatX = Eigen::MatrixXd;
using Triplets = std::vector<Eigen::Triplet<double>>;
using LandmarkRow = std::pair<int, int>;  // by landmark
// A landmark has at most the four degrees of freedom of a line.
using LandmarkMat = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic,
                                  Eigen::ColMajor, 4, 4>;

template <class Matrix>
Matrix SymmetricPseudoInverse(const Matrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(matrix);
  const auto& values = eigen.eigenvalues();
  const double floor = 1e-14 * std::max(0.0, values.maxCoeff());
  Matrix scaled = eigen.eigenvectors();
  for (Eigen::Index n = 0; n < values.size(); ++n) {
    scaled.col(n) *= values(n) > floor ? 1 / values(n) : 0.0;
  }
  return scaled * eigen.eigenvectors().transpose();
}

// J with the blocks of its columns; those of landmarks come first.
struct Jacobian {
  std::vector<double*> blocks;
  std::vector<int> start;     // by block, and the end
  std::vector<int> block_of;  // by column
  int landmark_count = 0;
  ceres::CRSMatrix rows;
  std::vector<double> residuals;

  explicit Jacobian(ProblemBuilder* builder) {
    const ceres::Problem& problem = builder->problem();
    landmark_count = static_cast<int>(builder->eliminated().size());
    blocks = builder->eliminated();
    blocks.insert(blocks.end(), builder->kept().begin(), builder->kept().end());
    for (std::size_t n = 0; n < blocks.size(); ++n) {
      start.push_back(static_cast<int>(block_of.size()));
      block_of.insert(block_of.end(),
                      problem.ParameterBlockTangentSize(blocks[n]),
                      static_cast<int>(n));
    }
    start.push_back(static_cast<int>(block_of.size()));
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = blocks;
    builder->problem().Evaluate(options, nullptr, &residuals, nullptr, &rows);
  }

  int Size(int block) const { return start[block + 1] - start[block]; }

  // The landmark that a row depends on, of which there is one at most; a number
  // of its own if there is none.
  int LandmarkOf(int row) const {
    for (int at = rows.rows[row]; at < rows.rows[row + 1]; ++at) {
      const int block = block_of[rows.cols[at]];
      if (block < landmark_count) return block;
    }
    return landmark_count + row;
  }
};

// Eliminates one landmark after the other.
class Elimination {
 public:
  Elimination(const Jacobian& jacobian, LinearisedProblem* problem)
      : jacobian_(jacobian),
        problem_(problem),
        first_kept_(jacobian.start[jacobian.landmark_count]),
        position_(jacobian.blocks.size()) {}

  // The rows [begin, end) of one landmark, or of none.
  void Add(const LandmarkRow* begin, const LandmarkRow* end) {
    const int size = FindBlocks(begin, end);
    const int own = OwnSize();
    // Of all columns and, as the last one, the residuals.
    MatX normal = MatX::Zero(size + 1, size + 1);
    for (const LandmarkRow* row = begin; row != end; ++row) {
      AddRow(row->second, &normal);
    }
    for (const int block : blocks_) {
      if (block < jacobian_.landmark_count) continue;
      for (int n = 0; n < jacobian_.Size(block); ++n) {
        problem_->kept_diagonal(jacobian_.start[block] - first_kept_ + n) +=
            normal(position_[block] + n, position_[block] + n);
      }
    }
    const int rest = size + 1 - own;
    if (own > 0) {
      const LandmarkMat inverse =
          SymmetricPseudoInverse<LandmarkMat>(normal.topLeftCorner(own, own));
      const MatX cross = normal.topRightCorner(own, rest);
      normal.bottomRightCorner(rest, rest) -=
          cross.transpose().lazyProduct(MatX(inverse.lazyProduct(cross)));
    }
    Distribute(normal);
  }

  Eigen::SparseMatrix<double> SchurComplement(int size) const {
    Triplets entries;
    for (const auto& [blocks, values] : sums_) {
      const int row = jacobian_.start[blocks.first] - first_kept_;
      const int col = jacobian_.start[blocks.second] - first_kept_;
      for (int i = 0; i < values.rows(); ++i) {
        for (int j = 0; j < values.cols(); ++j) {
          entries.emplace_back(row + i, col + j, values(i, j));
          if (row != col) entries.emplace_back(col + j, row + i, values(i, j));
        }
      }
    }
    Eigen::SparseMatrix<double> result(size, size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

 private:
  // The blocks of the rows, in order, and their places side by side.
  int FindBlocks(const LandmarkRow* begin, const LandmarkRow* end) {
    const ceres::CRSMatrix& rows = jacobian_.rows;
    blocks_.clear();
    for (const LandmarkRow* row = begin; row != end; ++row) {
      for (int at = rows.rows[row->second]; at < rows.rows[row->second + 1];
           ++at) {
        blocks_.push_back(jacobian_.block_of[rows.cols[at]]);
      }
    }
    std::sort(blocks_.begin(), blocks_.end());
    blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
    int size = 0;
    for (const int block : blocks_) {
      position_[block] = size;
      size += jacobian_.Size(block);
    }
    return size;
  }

  int OwnSize() const {
    return !blocks_.empty() && blocks_[0] < jacobian_.landmark_count
               ? jacobian_.Size(blocks_[0])
               : 0;
  }

  void AddRow(int row, MatX* normal) {
    entries_.clear();
    const ceres::CRSMatrix& rows = jacobian_.rows;
    for (int at = rows.rows[row]; at < rows.rows[row + 1]; ++at) {
      const int column = rows.cols[at], block = jacobian_.block_of[column];
      entries_.emplace_back(position_[block] + column - jacobian_.start[block],
                            rows.values[at]);
    }
    entries_.emplace_back(static_cast<int>(normal->cols()) - 1,
                          jacobian_.residuals[row]);
    for (const auto& [i, a] : entries_) {
      for (const auto& [j, b] : entries_) (*normal)(j, i) += a * b;
    }
  }

  void Distribute(const MatX& normal) {
    const auto last = normal.cols() - 1;
    auto& gradients = problem_->gradients;
    gradients.startVec(gradient_count_);
    for (const int a : blocks_) {
      if (a < jacobian_.landmark_count) continue;
      for (int n = 0; n < jacobian_.Size(a); ++n) {
        gradients.insertBack(gradient_count_,
                             jacobian_.start[a] - first_kept_ + n) =
            normal(position_[a] + n, last);
      }
      for (const int b : blocks_) {
        if (b < a) continue;
        const auto block = normal.block(position_[a], position_[b],
                                        jacobian_.Size(a), jacobian_.Size(b));
        const auto [sum, is_new] = sums_.try_emplace({a, b}, block);
        if (!is_new) sum->second += block;
      }
    }
    ++gradient_count_;
  }

  const Jacobian& jacobian_;
  LinearisedProblem* problem_;
  const int first_kept_;
  std::vector<int> position_;  // by block, of those of this landmark
  std::vector<int> blocks_;
  std::vector<std::pair<int, double>> entries_;
  Eigen::Index gradient_count_ = 0;
  std::map<std::pair<int, int>, MatX> sums_;  // upper half, by block
};

}  // namespace

MatX PseudoInverse(const MatX& matrix) {
  return SymmetricPseudoInverse(matrix);
}

LinearisedProblem::LinearisedProblem(ProblemBuilder* builder) {
  const Jacobian jacobian(builder);
  const int first = jacobian.start[jacobian.landmark_count];
  kept_size = jacobian.start.back() - first;
  redundancy = jacobian.rows.num_rows - first;
  for (std::size_t n = jacobian.landmark_count; n < jacobian.blocks.size();
       ++n) {
    blocks.push_back(jacobian.blocks[n]);
    start.push_back(jacobian.start[n] - first);
  }
  kept_diagonal = Eigen::VectorXd::Zero(kept_size);

  std::vector<LandmarkRow> rows;
  for (int row = 0; row < jacobian.rows.num_rows; ++row) {
    rows.push_back({jacobian.LandmarkOf(row), row});
  }
  std::sort(rows.begin(), rows.end());
  std::vector<const LandmarkRow*> ends = {rows.data()};
  for (const LandmarkRow& row : rows) {
    if (row.first != ends.back()->first) ends.push_back(&row);
  }
  ends.push_back(rows.data() + rows.size());
  gradients.resize(static_cast<Eigen::Index>(ends.size()) - 1, kept_size);
  Elimination elimination(jacobian, this);
  for (std::size_t n = 1; n < ends.size(); ++n) {
    elimination.Add(ends[n - 1], ends[n]);
  }
  gradients.finalize();
  schur_complement = elimination.SchurComplement(kept_size);
}

int LinearisedProblem::KeptColumn(const double* block) const {
  const auto found = std::find(blocks.begin(), blocks.end(), block);
  return found == blocks.end() ? -1 : start[found - blocks.begin()];
}

}  // namespace lowlap
