#include "lowlap/averaging/averager_registry.h"

#include <algorithm>

#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/bounded_lengths.h"
#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/averaging/strategies/internal/global_positioning.h"
#include "lowlap/averaging/strategies/internal/graph_scales.h"
#include "lowlap/averaging/strategies/internal/one_dsfm.h"
#include "lowlap/averaging/strategies/internal/revised_bata.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"
#include "lowlap/averaging/strategies/internal/scale_chain.h"
#include "lowlap/averaging/strategies/internal/triplet_programs.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

using Averager = AveragerRegistry::Averager;

// Makes an averager of a class that takes its options alone.
template <class Class>
struct Maker {
  template <class Options>
  Averager operator()(const Options& options) const {
    return std::make_shared<const Class>(options);
  }
};

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = text.find(separator, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

// "NAME:key=value,key=value".
Result<std::pair<std::string, OptionValues>> ParseEntry(
    const std::string& text) {
  const std::size_t colon = text.find(':');
  std::pair<std::string, OptionValues> entry{text.substr(0, colon), {}};
  if (colon == std::string::npos) return entry;
  for (const std::string& setting : Split(text.substr(colon + 1), ',')) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) {
      return MakeError(
          ErrorCode::kInvalidArgument,
          "strategy '" + entry.first + "': '" + setting + "' is not key=value");
    }
    if (!entry.second
             .emplace(setting.substr(0, equals), setting.substr(equals + 1))
             .second) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "strategy '" + entry.first + "': option '" +
                           setting.substr(0, equals) + "' is given twice");
    }
  }
  return entry;
}

template <class Entries>
auto FindEntry(const Entries& entries, const std::string& name) {
  return std::find_if(entries.begin(), entries.end(),
                      [&](const auto& entry) { return entry.name == name; });
}

Result<Averager> Named(const std::string& name, Result<Averager> made) {
  if (!made) {
    made.error().message = "strategy '" + name + "': " + made.error().message;
  }
  return made;
}

void DescribeEntry(const AveragerRegistry::Entry& entry, const char* suffix,
                   std::string* text) {
  *text += "  " + entry.name + suffix + ": " + entry.description + "\n";
  if (entry.options.empty()) *text += "      (no options)\n";
  for (const StrategyOption& option : entry.options) {
    *text += "      " + option.key + "=" + option.default_value + ": " +
             option.description + "\n";
  }
}

}  // namespace

AveragerRegistry AveragerRegistry::WithBuiltIns() {
  AveragerRegistry r;
  r.Register("graph", "average over all ratios and directions of any graph",
             GraphScalesOptions(), Maker<GraphScalesAverager>());
  // Trees of the best ratios and directions: nothing in it could be chosen.
  Strategy chain;
  chain.name = "chain";
  chain.description = "the paper's composition along the best ratios";
  chain.make = [](const OptionValues& values) -> Result<Averager> {
    if (values.empty()) return std::make_shared<const ScaleChainAverager>();
    return tl::unexpected<Error>(UnknownOption(values.begin()->first, {}));
  };
  r.Register(std::move(chain));
  r.Register("linf", "largest residual over triplets (Moulon et al. 2013)",
             TripletProgramOptions(), [](const TripletProgramOptions& options) {
               return std::make_shared<const TripletProgramAverager>(
                   TripletProgramAverager::Norm::kMaximum, options);
             });
  r.Register("l1_lp", "sum of absolute residuals over triplets",
             TripletProgramOptions(), [](const TripletProgramOptions& options) {
               return std::make_shared<const TripletProgramAverager>(
                   TripletProgramAverager::Norm::kSum, options);
             });
  r.Register("global_positioning",
             "centres and points from the rays of tracks (Pan et al. 2024)",
             GlobalPositioningOptions(), Maker<GlobalPositioningAverager>());
  // What solves the parts that directions fix, one by one.
  const auto by_parts = [&r](const char* name, const char* description,
                             const auto& defaults, auto* solve) {
    r.Register(name, description, defaults, [name, solve](const auto& options) {
      return std::make_shared<const DirectionAverager>(
          name, [solve, options](const DirectionPart& part,
                                 const RunContext& context, int* iterations) {
            return solve(part, options, context, iterations);
          });
    });
  };
  by_parts("l2_chordal", "constrained least squares (Tron, Vidal 2009)",
           BoundedLengthsOptions::L2Chordal(), SolveBoundedLengths);
  by_parts("soft_l1", "soft L1 on directions, as in OpenMVG",
           BoundedLengthsOptions::SoftL1(), SolveBoundedLengths);
  by_parts("lud", "least unsquared deviations (Ozyesil, Singer 2015)",
           BoundedLengthsOptions::Lud(), SolveBoundedLengths);
  by_parts("revised_lud",
           "LUD with one constraint on the scale (Zhuang et al. 2018)",
           RevisedLudOptions(), SolveRevisedLud);
  by_parts("bata", "bilinear angle-based averaging (Zhuang et al. 2018)",
           BataOptions(), SolveBata);
  by_parts("revised_bata", "the objective of bata at its minimum",
           RevisedBataOptions(), SolveRevisedBata);
  Filter filter;
  filter.name = "1dsfm";
  filter.description =
      "leaves out relative poses that orders of the views contradict (Wilson, "
      "Snavely 2014)";
  filter.options = ListOptions(OneDSfmOptions());
  filter.make = [](const OptionValues& values,
                   Averager inner) -> Result<Averager> {
    LOWLAP_ASSIGN_OR_RETURN(const auto options,
                            ReadOptions(values, OneDSfmOptions()));
    return std::make_shared<const OneDSfmAverager>(std::move(inner), options);
  };
  r.Register(std::move(filter));
  return r;
}

Status AveragerRegistry::CheckName(const std::string& name) const {
  if (name.empty() || name == "all" ||
      name.find_first_of(":,=+ \t\n") != std::string::npos) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "'" + name + "' cannot be the name of a strategy");
  }
  if (FindEntry(strategies_, name) != strategies_.end() ||
      FindEntry(filters_, name) != filters_.end()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "there is a strategy '" + name + "' already");
  }
  return {};
}

Status AveragerRegistry::Register(Strategy strategy) {
  Status status = CheckName(strategy.name);
  if (status) strategies_.push_back(std::move(strategy));
  return status;
}

Status AveragerRegistry::Register(Filter filter) {
  Status status = CheckName(filter.name);
  if (status) filters_.push_back(std::move(filter));
  return status;
}

std::vector<std::string> AveragerRegistry::Expand(
    const std::vector<std::string>& requests) const {
  std::vector<std::string> expanded;
  for (const std::string& request : requests) {
    for (const std::string& name :
         request == "all" ? Names() : std::vector<std::string>{request}) {
      if (std::find(expanded.begin(), expanded.end(), name) == expanded.end()) {
        expanded.push_back(name);
      }
    }
  }
  return expanded;
}

std::vector<std::string> AveragerRegistry::Names() const {
  std::vector<std::string> names;
  for (const Strategy& strategy : strategies_) names.push_back(strategy.name);
  return names;
}

Result<Averager> AveragerRegistry::Make(const std::string& request) const {
  const std::string first_name = request.substr(0, request.find_first_of(":+"));
  const auto filter = FindEntry(filters_, first_name);
  const std::size_t plus = request.find('+');
  const bool is_filtered =
      filter != filters_.end() && plus != std::string::npos;
  LOWLAP_ASSIGN_OR_RETURN(
      const auto entry,
      ParseEntry(is_filtered ? request.substr(0, plus) : request));
  const auto& [name, values] = entry;
  if (is_filtered) {
    LOWLAP_ASSIGN_OR_RETURN(auto inner, Make(request.substr(plus + 1)));
    return Named(name, filter->make(values, std::move(inner)));
  }
  const auto strategy = FindEntry(strategies_, name);
  if (strategy != strategies_.end()) {
    return Named(name, strategy->make(values));
  }
  std::string known;
  for (const std::string& each : Names()) {
    known += (known.empty() ? "" : ", ") + each;
  }
  for (const Filter& each : filters_) {
    known += "; each also behind the filter " + each.name + "+";
  }
  return MakeError(ErrorCode::kInvalidArgument,
                   "unknown strategy '" + name + "'; known: " + known);
}

std::string AveragerRegistry::Describe() const {
  std::string text =
      "Strategies: NAME or NAME:key=value,key=value; behind a filter: "
      "FILTER+NAME\n";
  for (const Strategy& strategy : strategies_) {
    DescribeEntry(strategy, "", &text);
  }
  for (const Filter& filter : filters_) DescribeEntry(filter, "+NAME", &text);
  return text;
}

std::vector<std::string> SplitRequests(const std::string& list) {
  std::vector<std::string> requests;
  for (const std::string& item : Split(list, ',')) {
    const std::size_t equals = item.find('=');
    const bool goes_on = equals != std::string::npos &&
                         item.find_first_of(":+") > equals && !requests.empty();
    if (goes_on) {
      requests.back() += "," + item;
    } else {
      requests.push_back(item);
    }
  }
  return requests;
}

}  // namespace lowlap
