#include "lowlap/averaging/strategies/internal/linear_program.h"

#include <algorithm>
#include <chrono>
#include <coin/ClpEventHandler.hpp>
#include <coin/ClpSimplex.hpp>
#include <coin/ClpSolve.hpp>
#include <exception>

#include "lowlap/averaging/internal/cancellation.h"

namespace lowlap {
namespace {

// Beyond so many rows Clp would of its own begin with a crash that cannot be
// stopped and takes seconds (AnswerToStop/linf/short_street, scale averaging
// benchmark).
constexpr std::size_t kMaxRowsOfClpsChoice = 40'000;

/// Lets the host stop the simplex method: every few of its steps, and where
/// these or what is between them take their time.
class StepAsker : public ClpEventHandler {
 public:
  StepAsker(const RunContext& context, int max_steps, Status* answer)
      : context_(context), max_steps_(max_steps), answer_(answer) {}
  int event(Event which) override {
    constexpr int kStop = 5;  // Clp's status of a run that its user stops
    constexpr std::chrono::milliseconds kMostBetweenQuestions(50);
    const int steps = model_->numberIterations();
    const bool is_due = which == endOfIteration && steps % 16 == 0;
    const auto now = std::chrono::steady_clock::now();
    if (*answer_ && (is_due || now > last_ + kMostBetweenQuestions)) {
      *answer_ = AskToGoOn(context_, std::min(steps, max_steps_), max_steps_);
      last_ = std::chrono::steady_clock::now();
    }
    // Clp stops between two steps, whatever it is told elsewhere.
    return *answer_ || which != endOfIteration ? -1 : kStop;
  }
  ClpEventHandler* clone() const override { return new StepAsker(*this); }

 private:
  const RunContext& context_;
  int max_steps_;
  Status* answer_;  // shared by the copies that Clp makes
  std::chrono::steady_clock::time_point last_ =
      std::chrono::steady_clock::now();
};

}  // namespace

std::size_t LinearProgram::AddVariable(double lower, double upper,
                                       double cost) {
  lower_.push_back(lower);
  upper_.push_back(upper);
  cost_.push_back(cost);
  columns_.emplace_back();
  return cost_.size() - 1;
}

void LinearProgram::AddRow(const std::vector<Term>& terms, double lower,
                           double upper) {
  for (const Term& term : terms) {
    columns_[term.variable].push_back({row_lower_.size(), term.factor});
  }
  row_lower_.push_back(lower);
  row_upper_.push_back(upper);
}

Result<LinearProgram::Optimum> LinearProgram::Minimize(
    const RunContext& context, int max_iterations) const {
  std::vector<CoinBigIndex> starts = {0};
  std::vector<int> rows;
  std::vector<double> factors;
  for (const std::vector<Entry>& column : columns_) {
    for (const Entry& entry : column) {
      rows.push_back(static_cast<int>(entry.row));
      factors.push_back(entry.factor);
    }
    starts.push_back(static_cast<CoinBigIndex>(rows.size()));
  }
  try {
    Status answer = AskToGoOn(context, 0, 1);
    if (!answer) return tl::unexpected<Error>(answer.error());
    const StepAsker asker(context, max_iterations, &answer);
    ClpSimplex model;
    model.setLogLevel(0);
    model.passInEventHandler(&asker);
    model.loadProblem(static_cast<int>(num_variables()),
                      static_cast<int>(num_rows()), starts.data(), rows.data(),
                      factors.data(), lower_.data(), upper_.data(),
                      cost_.data(), row_lower_.data(), row_upper_.data());
    model.setMaximumIterations(max_iterations);
    ClpSolve method;
    // Its handler of interrupts would take the place of the program's, and from
    // several threads stay there. StepAsker stops it.
    method.setSpecialOption(2, 1);
    if (num_rows() > kMaxRowsOfClpsChoice) {
      method.setSolveType(ClpSolve::useDual);
    }
    model.initialSolve(method);
    if (!answer) return tl::unexpected<Error>(answer.error());
    constexpr int kOptimal = 0;
    if (model.status() != kOptimal) {
      return MakeError(ErrorCode::kNumerical,
                       "the linear program of the camera centres has no "
                       "optimum within the allowed iterations");
    }
    Optimum optimum;
    const double* values = model.primalColumnSolution();
    optimum.values.assign(values, values + num_variables());
    optimum.objective = model.objectiveValue();
    optimum.num_iterations = model.numberIterations();
    return optimum;
  } catch (const std::exception& error) {
    return MakeError(ErrorCode::kNumerical,
                     std::string("the linear program of the camera centres "
                                 "failed: ") +
                         error.what());
  } catch (...) {  // CoinError is no std::exception.
    return MakeError(ErrorCode::kNumerical,
                     "the linear program of the camera centres failed");
  }
}

}  // namespace lowlap
