#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace lowlap {

/// Records of a CSV text (RFC 4180) by column name. Fails the test if a record
/// has not as many cells as the header.
inline std::vector<std::map<std::string, std::string>> ReadCsv(
    const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    std::string& cell = rows.back().back();
    if (quoted) {
      if (c != '"') {
        cell += c;
      } else if (n + 1 < text.size() && text[n + 1] == '"') {
        cell += '"';
        ++n;
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\n') {
      if (n + 1 < text.size()) rows.emplace_back(1);
    } else {
      cell += c;
    }
  }
  std::vector<std::map<std::string, std::string>> records;
  for (std::size_t n = 1; n < rows.size(); ++n) {
    EXPECT_EQ(rows[n].size(), rows[0].size()) << "record " << n;
    records.emplace_back();
    for (std::size_t k = 0; k < std::min(rows[n].size(), rows[0].size()); ++k) {
      records.back()[rows[0][k]] = rows[n][k];
    }
  }
  return records;
}

}  // namespace lowlap
