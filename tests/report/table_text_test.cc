#include "lowlap/report/internal/table_text.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

TEST(TableTextTest, ColumnsAreAligned) {
  const TextTable table{{"name", "x"}, {{"a", "1.5"}, {"long name", "22"}}};
  EXPECT_EQ(ToAlignedText(table),
            "name         x\n"
            "a          1.5\n"
            "long name   22\n");
}

TEST(TableTextTest, MissingCellsAreEmptyAndCharactersAreCounted) {
  const TextTable table{{"n", "x"}, {{"é", "1"}, {"b"}}};
  EXPECT_EQ(ToAlignedText(table), "n  x\né  1\nb\n");
  EXPECT_EQ(ToCsv(table), "n,x\né,1\nb,\n");
}

TEST(TableTextTest, CsvQuotesWhatWouldBreakIt) {
  const TextTable table{{"a", "b"},
                        {{"1,5", "say \"no\""}, {"two\nlines", ""}}};
  EXPECT_EQ(ToCsv(table), "a,b\n\"1,5\",\"say \"\"no\"\"\"\n\"two\nlines\",\n");
}

TEST(TableTextTest, Numbers) {
  EXPECT_EQ(NumberText(0.25, 4), "0.25");
  EXPECT_EQ(NumberText(1.0 / 3, 3), "0.333");
  EXPECT_EQ(NumberText(0, 3), "0");
}

}  // namespace
}  // namespace lowlap
