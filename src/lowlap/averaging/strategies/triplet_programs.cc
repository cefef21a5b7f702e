#include "lowlap/averaging/strategies/internal/triplet_programs.h"

#include <map>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/linear_program.h"
#include "lowlap/averaging/strategies/internal/placed_parts.h"
#include "lowlap/averaging/strategies/internal/triplet_baselines.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

using Norm = TripletProgramAverager::Norm;

// The simplex method takes ten seconds or so at this size, on a street, and
// grows with the square or the cube of it.
constexpr std::size_t kMaxTripletsOfMaximum = 6000;
constexpr std::size_t kMaxTripletsOfSum = 2000;

Status CheckSize(const std::string& name, Norm norm, std::size_t size) {
  const std::size_t most =
      norm == Norm::kMaximum ? kMaxTripletsOfMaximum : kMaxTripletsOfSum;
  if (size <= most) return {};
  return MakeError(ErrorCode::kUnsupported,
                   name + ": " + std::to_string(size) +
                       " triplets hang together; its linear program is solved "
                       "for at most " +
                       std::to_string(most));
}

/// The linear program of one set of triplets.
class CenterProgram {
 public:
  CenterProgram(const TranslationProblem& problem, Norm norm)
      : problem_(problem), norm_(norm) {
    if (norm_ == Norm::kMaximum) gamma_ = program_.AddVariable(0, kNone, 1);
  }

  void Add(const TripletMotion& motion) {
    const std::size_t lambda = program_.AddVariable(1, kNone, 0);
    for (int n = 0; n < 3; ++n) {
      const DirectionEdge& edge = problem_.edges[motion.edges[n]];
      const std::size_t first = CenterOf(edge.first);
      const std::size_t second = CenterOf(edge.second);
      for (int axis = 0; axis < 3; ++axis) {
        AddResidual({{second + axis, 1.0},
                     {first + axis, -1.0},
                     {lambda, -motion.baselines[n](axis)}});
      }
    }
  }

  Result<LinearProgram::Optimum> Minimize(const RunContext& context) const {
    return program_.Minimize(context);
  }

  /// View -> first of its three variables.
  const std::map<std::size_t, std::size_t>& centers() const { return centers_; }

 private:
  static constexpr double kNone = LinearProgram::kInfinity;

  std::size_t CenterOf(std::size_t view) {
    const auto found = centers_.find(view);
    if (found != centers_.end()) return found->second;
    // The first view is the origin.
    const double bound = centers_.empty() ? 0.0 : kNone;
    const std::size_t x = program_.AddVariable(-bound, bound, 0);
    program_.AddVariable(-bound, bound, 0);
    program_.AddVariable(-bound, bound, 0);
    centers_[view] = x;
    return x;
  }

  void AddResidual(std::vector<LinearProgram::Term> terms) {
    if (norm_ == Norm::kMaximum) {
      terms.push_back({gamma_, -1.0});
      program_.AddRow(terms, -kNone, 0);
      terms.back().factor = 1.0;
      program_.AddRow(terms, 0, kNone);
      return;
    }
    // residual = excess - lack; at the optimum one of them is 0.
    const std::size_t excess = program_.AddVariable(0, kNone, 1);
    const std::size_t lack = program_.AddVariable(0, kNone, 1);
    terms.push_back({excess, -1.0});
    terms.push_back({lack, 1.0});
    program_.AddRow(terms, 0, 0);
  }

  const TranslationProblem& problem_;
  Norm norm_;
  LinearProgram program_;
  std::size_t gamma_ = 0;
  std::map<std::size_t, std::size_t> centers_;
};

}  // namespace

Status TripletProgramOptions::Validate() const {
  if (max_closure_deg >= 0 && min_angle_deg >= 0 && max_triplets_per_edge > 0) {
    return {};
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "angles must not be negative, and the number of triplets "
                   "must be positive");
}

Result<TranslationSolution> TripletProgramAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  LOWLAP_RETURN_IF_ERROR(ValidateProblem(problem));
  LOWLAP_RETURN_IF_ERROR(options_.Validate());
  LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, 0, 1));
  PlacedParts parts(problem.views.size());
  int num_iterations = 0;
  for (const std::vector<TripletMotion>& triplets :
       FindTripletBaselines(problem, options_)) {
    LOWLAP_RETURN_IF_ERROR(CheckSize(Name(), norm_, triplets.size()));
    CenterProgram program(problem, norm_);
    for (const TripletMotion& motion : triplets) program.Add(motion);
    std::vector<std::size_t> views;
    for (const auto& entry : program.centers()) views.push_back(entry.first);
    if (parts.HasAll(views)) continue;
    LOWLAP_ASSIGN_OR_RETURN(const auto optimum, program.Minimize(context));
    num_iterations += optimum.num_iterations;
    std::vector<Vec3> centers;
    for (const auto& entry : program.centers()) {
      const std::size_t x = entry.second;
      centers.emplace_back(optimum.values[x], optimum.values[x + 1],
                           optimum.values[x + 2]);
    }
    parts.Add(std::move(views), std::move(centers));
  }
  TranslationSolution solution = std::move(parts).MakeSolution();
  solution.num_iterations = num_iterations;
  return solution;
}

}  // namespace lowlap
