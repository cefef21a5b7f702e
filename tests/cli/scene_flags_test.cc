// What commands on a solved or measured scene do with it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli_fixture.h"

namespace lowlap {
namespace {

class SceneFlags : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(Lowlap("simulate --views 5 --points 40 --lines 20 --noise 0.5 "
                     "-o " +
                     Room() + " --truth " + Truth())
                  .exit_code,
              0);
  }
  std::string Room() const { return Path("room.lowlap"); }
  std::string Truth() const { return Path("truth.lowlap"); }
};

TEST_F(SceneFlags, TheSummaryOfAdjustHasNoGrades) {
  const auto summary_of = [&](const std::string& command) {
    const Outcome outcome = Lowlap(command + " -o " + Path("out"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    return nlohmann::json::parse(ReadText(Path("out/summary.json")))["solve"];
  };
  const auto solved = summary_of("solve " + Room());
  EXPECT_TRUE(solved["poses"].contains("grades"));
  EXPECT_TRUE(solved.contains("structure"));
  const auto adjusted = summary_of("adjust " + Truth());
  EXPECT_EQ(adjusted["poses"]["placed"], 5);
  EXPECT_FALSE(adjusted["poses"].contains("grades"));
  EXPECT_FALSE(adjusted["poses"].contains("doubtful"));
  EXPECT_FALSE(adjusted.contains("structure"));
  const auto points = summary_of("adjust " + Truth() +
                                 " --adjust-features points --retriangulate");
  EXPECT_TRUE(points.contains("structure"));
  EXPECT_TRUE(points["adjustment"]["coplanar"]["final_rmse_px"].is_null());
}

}  // namespace
}  // namespace lowlap
