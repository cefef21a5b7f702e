#include "lowlap/averaging/averager_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(AveragerRegistry, TheDefaultComesFirst) {
  const AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  ASSERT_FALSE(registry.Names().empty());
  EXPECT_EQ(registry.Names().front(), "graph");
  for (const std::string& name : registry.Names()) {
    const auto made = registry.Make(name);
    ASSERT_TRUE(made) << name;
    EXPECT_EQ((*made)->Name(), name);
    EXPECT_THAT(registry.Describe(), HasSubstr("  " + name + ": "));
  }
}

TEST(AveragerRegistry, SaysWhereThereIsNoOption) {
  EXPECT_THAT(AveragerRegistry::WithBuiltIns().Describe(),
              HasSubstr("best ratios\n      (no options)\n  linf: "));
}

TEST(AveragerRegistry, EveryDefaultCanBeReadBack) {
  const AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  for (const AveragerRegistry::Strategy& strategy : registry.strategies()) {
    OptionValues values;
    for (const StrategyOption& option : strategy.options) {
      values[option.key] = option.default_value;
    }
    const auto made = strategy.make(values);
    EXPECT_TRUE(made) << strategy.name << ": " << made.error().message;
  }
}

std::string RefusalOf(const std::string& request) {
  const auto made = AveragerRegistry::WithBuiltIns().Make(request);
  if (made) return "";
  EXPECT_EQ(made.error().code, ErrorCode::kInvalidArgument);
  return made.error().message;
}

TEST(AveragerRegistry, RefusalsNameWhatIsKnown) {
  EXPECT_THAT(RefusalOf("magic"), HasSubstr("known: graph, chain"));
  EXPECT_THAT(RefusalOf(""), HasSubstr("known: graph, chain"));
  EXPECT_THAT(RefusalOf("1dsfm"), HasSubstr("1dsfm+"));
  EXPECT_THAT(RefusalOf("1dsfm+magic"), HasSubstr("unknown strategy 'magic'"));
  EXPECT_THAT(RefusalOf("lud:width=1"),
              HasSubstr("strategy 'lud': no option 'width'; known: "
                        "loss_width, max_iterations"));
  EXPECT_THAT(RefusalOf("chain:a=1"), HasSubstr("no option 'a'; known: none"));
  EXPECT_THAT(RefusalOf("lud:loss_width=wide"),
              HasSubstr("option 'loss_width': 'wide' is not a number"));
  EXPECT_THAT(RefusalOf("lud:max_iterations=1.5"), HasSubstr("whole number"));
  EXPECT_THAT(RefusalOf("lud:max_iterations=0"), HasSubstr("positive"));
  EXPECT_THAT(RefusalOf("global_positioning:min_views_per_track=-2"),
              HasSubstr("not negative"));
  EXPECT_THAT(RefusalOf("lud:loss_width"), HasSubstr("is not key=value"));
  EXPECT_THAT(RefusalOf("lud:"), HasSubstr("is not key=value"));
  EXPECT_THAT(RefusalOf("lud:max_iterations=1,max_iterations=2"),
              HasSubstr("given twice"));
  EXPECT_THAT(RefusalOf("1dsfm:magic=1+lud"),
              HasSubstr("strategy '1dsfm': no option 'magic'; known: "
                        "num_projections, max_contradiction"));
}

// The option reaches the strategy: a track of two views counts only with it.
TEST(AveragerRegistry, OptionsReachTheStrategy) {
  const AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  EXPECT_THAT((*registry.Make("global_positioning"))->Needs(),
              HasSubstr("at least 3 views"));
  EXPECT_THAT(
      (*registry.Make("global_positioning:min_views_per_track=2"))->Needs(),
      HasSubstr("at least 2 views"));
  EXPECT_THAT((*registry.Make("1dsfm:max_contradiction=0.2+"
                              "global_positioning:min_views_per_track=2"))
                  ->Needs(),
              HasSubstr("at least 2 views"));
}

struct LineOptions {
  double step = 1;
  bool backwards = false;
  std::string label = "line";

  Status Validate() const {
    if (step > 0) return {};
    return MakeError(ErrorCode::kInvalidArgument, "the step must be positive");
  }
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("step", &step, "distance of neighbours");
    visit("backwards", &backwards, "from the last to the first");
    visit("label", &label, "its name");
  }
};

/// Puts the views on a line.
class LineAverager : public TranslationAverager {
 public:
  explicit LineAverager(LineOptions options) : options_(std::move(options)) {}
  std::string Name() const override { return options_.label; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext&) const override {
    TranslationSolution solution;
    solution.num_components = 1;
    for (std::size_t n = 0; n < problem.views.size(); ++n) {
      solution.component.push_back(0);
      solution.center_in_world.push_back(
          (options_.backwards ? -1.0 : 1.0) * options_.step *
          static_cast<double>(n) * Vec3::UnitX());
    }
    return solution;
  }

 private:
  LineOptions options_;
};

TEST(AveragerRegistry, AllStandsForEveryNameOnce) {
  const AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  EXPECT_EQ(registry.Expand({"all", "chain"}), registry.Names());
  EXPECT_THAT(registry.Expand({"magic", "lud", "magic"}),
              ElementsAre("magic", "lud"));
}

TEST(AveragerRegistry, TakesStrategiesFromOutside) {
  AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  const auto make = [](const LineOptions& options) {
    return std::make_shared<const LineAverager>(options);
  };
  ASSERT_TRUE(
      registry.Register("line", "views on a line", LineOptions(), make));
  EXPECT_EQ(registry.Names().back(), "line");
  EXPECT_THAT(registry.Describe(),
              HasSubstr("line: views on a line\n"
                        "      step=1: distance of neighbours\n"
                        "      backwards=false: from the last"));
  const auto made =
      registry.Make("1dsfm+line:step=0.25,backwards=true,label=a b");
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_EQ((*made)->Name(), "1dsfm+a b");
  const RandomProblem problem = MakeRandomProblem(
      3, std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {1, 2}}, 1);
  const auto solution = (*made)->Solve(problem.problem, RunContext());
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->center_in_world[2], Vec3(-0.5, 0, 0));
  EXPECT_FALSE(registry.Make("line:step=0"));
  EXPECT_FALSE(registry.Make("line:backwards=yes"));

  for (const char* name : {"line", "graph", "1dsfm", "all", "", "a:b", "a+b",
                           "a b", "a,b", "a=b"}) {
    EXPECT_FALSE(
        registry.Register(name, "taken, or not a name", LineOptions(), make))
        << name;
  }
}

TEST(SplitRequests, ACommaBeforeKeyAndValueDoesNotSeparate) {
  EXPECT_THAT(
      SplitRequests("graph,lud:loss_width=1e-5,max_iterations=50,bata"),
      ElementsAre("graph", "lud:loss_width=1e-5,max_iterations=50", "bata"));
  EXPECT_THAT(SplitRequests("1dsfm:num_projections=9,max_contradiction=0.2+"
                            "lud:loss_width=1,max_iterations=3,all"),
              ElementsAre("1dsfm:num_projections=9,max_contradiction=0.2+"
                          "lud:loss_width=1,max_iterations=3",
                          "all"));
  EXPECT_THAT(SplitRequests("graph"), ElementsAre("graph"));
  EXPECT_THAT(SplitRequests("graph,,lud"), ElementsAre("graph", "", "lud"));
}

}  // namespace
}  // namespace lowlap
