#include "lowlap/adjustment/internal/rounds/linearised_problem.h"

#include <ceres/crs_matrix.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <utility>

namespace lowlap {
namespace {

using MatX = Eigen::MatrixXd;
using LandmarkRow = std::pair<int, int>;  // landmark, row

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
        place_(jacobian.blocks.size()) {}

  // The rows [begin, end) of one landmark, or of none.
  void Add(const LandmarkRow* begin, const LandmarkRow* end) {
    PlaceBlocks(begin, end);
    normal_.assign(size_ * size_, 0);
    for (const LandmarkRow* row = begin; row != end; ++row) AddRow(row->second);
    std::size_t first = 0;  // of the kept blocks
    if (!blocks_.empty() && blocks_[0] < jacobian_.landmark_count) {
      EliminateFirst(jacobian_.Size(blocks_[0]));
      first = 1;
    }
    TakeGradient(first);
    for (std::size_t a = first; a < blocks_.size(); ++a) {
      for (std::size_t b = a; b < blocks_.size(); ++b) {
        AddToSum(blocks_[a], blocks_[b]);
      }
    }
  }

  SparseMat SchurComplement() const {
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& [blocks, sum] : sums_) {
      const int row = jacobian_.start[blocks.first] - first_kept_;
      const int col = jacobian_.start[blocks.second] - first_kept_;
      auto value = sum.begin();
      for (int i = 0; i < jacobian_.Size(blocks.first); ++i) {
        for (int j = 0; j < jacobian_.Size(blocks.second); ++j, ++value) {
          entries.emplace_back(row + i, col + j, *value);
          if (row != col) entries.emplace_back(col + j, row + i, *value);
        }
      }
    }
    Eigen::SparseMatrix<double> result(problem_->kept_size,
                                       problem_->kept_size);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
  }

 private:
  double* Row(int row) { return normal_.data() + row * size_; }

  // Puts the columns of the rows' blocks side by side; the residuals follow.
  void PlaceBlocks(const LandmarkRow* begin, const LandmarkRow* end) {
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
    size_ = 1;
    for (const int block : blocks_) {
      place_[block] = size_ - 1;
      size_ += jacobian_.Size(block);
    }
  }

  // The normal equations, above the diagonal, with the residuals as the last
  // column.
  void AddRow(int row) {
    const ceres::CRSMatrix& rows = jacobian_.rows;
    entries_.clear();
    for (int at = rows.rows[row]; at < rows.rows[row + 1]; ++at) {
      const int column = rows.cols[at], block = jacobian_.block_of[column];
      entries_.emplace_back(place_[block] + column - jacobian_.start[block],
                            rows.values[at]);
      if (column >= first_kept_) {
        problem_->kept_diagonal(column - first_kept_) +=
            rows.values[at] * rows.values[at];
      }
    }
    entries_.emplace_back(size_ - 1, jacobian_.residuals[row]);
    for (const auto& [i, a] : entries_) {
      for (const auto& [j, b] : entries_) {
        if (j >= i) Row(i)[j] += a * b;
      }
    }
  }

  // The largest pivots first. What the rows do not determine has no part in
  // their other columns, and stays.
  void EliminateFirst(int count) {
    double floor = 0;
    for (int n = 0; n < count; ++n) floor = std::max(floor, Row(n)[n] * 1e-14);
    column_.resize(size_);
    for (int step = 0; step < count; ++step) {
      int pivot = 0;
      for (int n = 1; n < count; ++n) {
        if (Row(n)[n] > Row(pivot)[pivot]) pivot = n;
      }
      const double value = Row(pivot)[pivot];
      if (!(value > floor)) return;
      for (int n = 0; n < size_; ++n) {
        column_[n] = n < pivot ? Row(n)[pivot] : Row(pivot)[n];
      }
      for (int i = 0; i < size_; ++i) {
        const double factor = column_[i] / value;
        double* const row = Row(i);
        for (int j = i; j < size_; ++j) row[j] -= factor * column_[j];
      }
      Row(pivot)[pivot] = 0;
    }
  }

  void TakeGradient(std::size_t first) {
    auto& gradients = problem_->gradients;
    gradients.startVec(gradient_count_);
    for (std::size_t a = first; a < blocks_.size(); ++a) {
      for (int n = 0; n < jacobian_.Size(blocks_[a]); ++n) {
        gradients.insertBack(gradient_count_,
                             jacobian_.start[blocks_[a]] - first_kept_ + n) =
            Row(place_[blocks_[a]] + n)[size_ - 1];
      }
    }
    ++gradient_count_;
  }

  void AddToSum(int a, int b) {
    const int rows = jacobian_.Size(a), cols = jacobian_.Size(b);
    std::vector<double>& sum = sums_[{a, b}];
    sum.resize(static_cast<std::size_t>(rows) * cols);
    double* value = sum.data();
    for (int i = 0; i < rows; ++i) {
      const double* row = Row(place_[a] + i) + place_[b];
      for (int j = 0; j < cols; ++j) {
        *value++ +=
            a == b && j < i ? Row(place_[a] + j)[place_[a] + i] : row[j];
      }
    }
  }

  const Jacobian& jacobian_;
  LinearisedProblem* problem_;
  const int first_kept_;
  // Of the present landmark.
  std::vector<int> blocks_;  // in order
  std::vector<int> place_;   // by block
  int size_ = 0;             // of all their columns, and one
  std::vector<double> normal_;
  std::vector<double> column_;
  std::vector<std::pair<int, double>> entries_;
  Eigen::Index gradient_count_ = 0;
  std::map<std::pair<int, int>, std::vector<double>> sums_;  // upper half
};

}  // namespace

MatX PseudoInverse(const MatX& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(matrix);
  const Eigen::VectorXd& values = eigen.eigenvalues();
  const double floor = 1e-14 * std::max(0.0, values.maxCoeff());
  MatX scaled = eigen.eigenvectors();
  for (Eigen::Index n = 0; n < values.size(); ++n) {
    scaled.col(n) *= values(n) > floor ? 1 / values(n) : 0.0;
  }
  return scaled * eigen.eigenvectors().transpose();
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
  rows.reserve(static_cast<std::size_t>(jacobian.rows.num_rows));
  for (int row = 0; row < jacobian.rows.num_rows; ++row) {
    rows.emplace_back(jacobian.LandmarkOf(row), row);
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
  schur_complement = elimination.SchurComplement();
}

int LinearisedProblem::KeptColumn(const double* block) const {
  const auto found = std::find(blocks.begin(), blocks.end(), block);
  return found == blocks.end() ? -1 : start[found - blocks.begin()];
}

}  // namespace lowlap
