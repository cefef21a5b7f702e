#include "lowlap/averaging/strategy_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lowlap {
namespace {

using ::testing::HasSubstr;

template <class Value>
void ReadsBack(const Value& value) {
  Value read{};
  const std::string text = OptionText(value);
  ASSERT_TRUE(ReadOption("key", text, &read)) << text;
  EXPECT_EQ(read, value) << text;
}

TEST(OptionText, IsReadBackAsTheSameValue) {
  for (const int value : {0, -7, std::numeric_limits<int>::min(),
                          std::numeric_limits<int>::max()}) {
    ReadsBack(value);
  }
  ReadsBack(std::numeric_limits<std::size_t>::max());
  for (const double value : {0.0, 0.1, 1.0 / 3, -1e-6, 5e-324, HUGE_VAL,
                             -HUGE_VAL, std::numeric_limits<double>::max()}) {
    ReadsBack(value);
  }
  ReadsBack(true);
  ReadsBack(false);
  ReadsBack(std::string());
  ReadsBack(std::string("a b=c"));
}

TEST(OptionText, IsAsShortAsAPersonWouldWriteIt) {
  EXPECT_EQ(OptionText(0.1), "0.1");
  EXPECT_EQ(OptionText(1e-6), "1e-06");
  EXPECT_EQ(OptionText(2.0), "2");
  EXPECT_EQ(OptionText(HUGE_VAL), "inf");
  EXPECT_EQ(OptionText(true), "true");
}

template <class Value>
void Refuses(const Value& before, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    Value value = before;
    const Status status = ReadOption("the_key", text, &value);
    ASSERT_FALSE(status) << text;
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
    EXPECT_THAT(status.error().message, HasSubstr("'the_key'"));
    EXPECT_THAT(status.error().message, HasSubstr("'" + text + "'"));
    EXPECT_EQ(value, before) << text;
  }
}

TEST(ReadOption, RefusesWhatIsNoSuchValueAndChangesNothing) {
  Refuses(41, {"", "x", "1.5", "1 ", " 1", "+1", "1x", "2147483648", "0x10"});
  Refuses(std::size_t{41}, {"", "-1", "1.0", "18446744073709551616"});
  Refuses(0.5, {"", "wide", "1,5", "1e400", "nan", "-nan", "1 "});
  Refuses(true, {"", "yes", "1", "False"});
}

struct Options {
  int count = 3;
  double width = 0.25;
  std::string label = "l";

  Status Validate() const {
    if (count > 0) return {};
    return MakeError(ErrorCode::kInvalidArgument, "the count must be positive");
  }
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("count", &count, "how many");
    visit("width", &width, "how wide");
    visit("label", &label, "what");
  }
};

TEST(ListOptions, HasEveryOptionWithItsDefaultInOrder) {
  Options defaults;
  defaults.width = 1.5;
  const std::vector<StrategyOption> list = ListOptions(defaults);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].key, "count");
  EXPECT_EQ(list[0].default_value, "3");
  EXPECT_EQ(list[0].description, "how many");
  EXPECT_EQ(list[1].default_value, "1.5");
  EXPECT_EQ(list[2].default_value, "l");
}

TEST(ReadOptions, KeepsTheDefaultsThatNoValueReplaces) {
  Options defaults;
  defaults.width = 1.5;
  const auto none = ReadOptions({}, defaults);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->count, 3);
  EXPECT_EQ(none->width, 1.5);
  const auto options = ReadOptions({{"count", "7"}, {"label", ""}}, defaults);
  ASSERT_TRUE(options);
  EXPECT_EQ(options->count, 7);
  EXPECT_EQ(options->width, 1.5);
  EXPECT_EQ(options->label, "");
}

std::string RefusalOf(const OptionValues& values) {
  const auto options = ReadOptions(values, Options());
  if (options) return "";
  EXPECT_EQ(options.error().code, ErrorCode::kInvalidArgument);
  return options.error().message;
}

TEST(ReadOptions, RefusesUnknownKeysWrongValuesAndInvalidOptions) {
  EXPECT_EQ(RefusalOf({{"high", "1"}}),
            "no option 'high'; known: count, width, label");
  EXPECT_THAT(RefusalOf({{"count", "7.5"}}), HasSubstr("'count'"));
  // The first one that is wrong, whatever is right beside it.
  EXPECT_THAT(RefusalOf({{"count", "x"}, {"width", "1"}}), HasSubstr("'x'"));
  EXPECT_EQ(RefusalOf({{"count", "0"}}), "the count must be positive");
}

TEST(UnknownOption, SaysSoIfThereAreNone) {
  EXPECT_EQ(UnknownOption("a", {}).message, "no option 'a'; known: none");
}

}  // namespace
}  // namespace lowlap
