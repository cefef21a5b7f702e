#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/strategy_options.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// Strategies by name, from this tree and from outside it.
///
/// A strategy is asked for by `NAME` or `NAME:key=value,key=value`, behind
/// filters if wanted: `FILTER+NAME`, `FILTER:key=value+NAME:key=value`.
class AveragerRegistry {
 public:
  using Averager = std::shared_ptr<const TranslationAverager>;

  struct Entry {
    std::string name;         // without any of ":,=+" and spaces
    std::string description;  // one line
    std::vector<StrategyOption> options;
  };
  struct Strategy : Entry {
    std::function<Result<Averager>(const OptionValues&)> make;
  };
  /// Changes the problem, then passes it on to the averager behind it.
  struct Filter : Entry {
    std::function<Result<Averager>(const OptionValues&, Averager)> make;
  };

  /// The strategies and filters of lowlap; the default comes first.
  static AveragerRegistry WithBuiltIns();

  /// kInvalidArgument for a name that is taken or has a character of the
  /// grammar above.
  Status Register(Strategy strategy);
  Status Register(Filter filter);

  /// A strategy with an options struct (see ListOptions) and a way to make an
  /// averager of them: Averager(const Options&).
  template <class Options, class Make>
  Status Register(std::string name, std::string description,
                  const Options& defaults, const Make& make) {
    Strategy strategy;
    strategy.name = std::move(name);
    strategy.description = std::move(description);
    strategy.options = ListOptions(defaults);
    strategy.make = [defaults,
                     make](const OptionValues& values) -> Result<Averager> {
      const auto options = ReadOptions(values, defaults);
      if (!options) return tl::unexpected<Error>(options.error());
      return Averager(make(*options));
    };
    return Register(std::move(strategy));
  }

  const std::vector<Strategy>& strategies() const { return strategies_; }
  const std::vector<Filter>& filters() const { return filters_; }
  std::vector<std::string> Names() const;
  /// Requests with every name in place of "all", each of them once.
  std::vector<std::string> Expand(
      const std::vector<std::string>& requests) const;

  /// kInvalidArgument, with what is known, for an unknown name or key, or a
  /// value that is not one of the option.
  Result<Averager> Make(const std::string& request) const;

  /// For people: every strategy and filter with its options and their defaults.
  std::string Describe() const;

 private:
  Status CheckName(const std::string& name) const;

  std::vector<Strategy> strategies_;
  std::vector<Filter> filters_;
};

/// Requests that commas separate. A comma before `key=value` belongs to the
/// request before it: "graph,lud:loss_width=1e-5,max_iterations=50,bata" are
/// three.
std::vector<std::string> SplitRequests(const std::string& list);

}  // namespace lowlap
