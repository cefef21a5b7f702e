#include "lowlap/core/internal/format.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

TEST(Format, WritesWhatPrintfDoes) {
  EXPECT_EQ(Format("%d of %s: %.2f", 3, "five", 0.6), "3 of five: 0.60");
  EXPECT_EQ(Format("%s", ""), "");
}

TEST(Format, DoesNotCutLongTexts) {
  const std::string name(1000, 'x');
  EXPECT_EQ(Format("%s\n", name.c_str()), name + "\n");
}

TEST(Escaped, ShowsWhatCannotBeShown) {
  EXPECT_EQ(Escaped("K\xff\n.txt"), "K\\xFF\\x0A.txt");
}

TEST(Printable, LeavesWhatATerminalShows) {
  EXPECT_EQ(Printable("caf\xC3\xA9\n\x1B[2J\x7F"),
            "caf\xC3\xA9\n\\x1B[2J\\x7F");
  EXPECT_EQ(Printable("caf\xC3\xA9 \xFF"), "caf\\xC3\\xA9 \\xFF");
}

}  // namespace
}  // namespace lowlap
