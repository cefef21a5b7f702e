#include "lowlap/averaging/strategies/internal/linear_program.h"

#include <coin/Clp_C_Interface.h>

#include <exception>
#include <memory>

namespace lowlap {

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
    int max_iterations) const {
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
    const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex*)> model(
        Clp_newModel(), [](Clp_Simplex* m) { Clp_deleteModel(m); });
    Clp_setLogLevel(model.get(), 0);
    Clp_loadProblem(model.get(), static_cast<int>(num_variables()),
                    static_cast<int>(num_rows()), starts.data(), rows.data(),
                    factors.data(), lower_.data(), upper_.data(), cost_.data(),
                    row_lower_.data(), row_upper_.data());
    Clp_setMaximumIterations(model.get(), max_iterations);
    Clp_initialSolve(model.get());
    constexpr int kOptimal = 0;
    if (Clp_status(model.get()) != kOptimal) {
      return MakeError(ErrorCode::kNumerical,
                       "the linear program of the camera centres has no "
                       "optimum within the allowed iterations");
    }
    Optimum optimum;
    const double* values = Clp_primalColumnSolution(model.get());
    optimum.values.assign(values, values + num_variables());
    optimum.objective = Clp_objectiveValue(model.get());
    optimum.num_iterations = Clp_numberIterations(model.get());
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
