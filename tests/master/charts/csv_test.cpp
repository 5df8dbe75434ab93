#include "master/charts/csv.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

TEST(Csv, WhatWasWrittenIsRead) {
  const std::vector<CsvRow> rows{{"a", "b"}, {"1,5", "say \"so\""}, {"", "two\nlines"}, {"x", ""}};
  std::string text;
  for (const CsvRow& row : rows) text += csv_line(row);
  EXPECT_EQ(csv_rows(text), rows);
}

TEST(Csv, ALineOfAnotherLengthIsNamed) {
  try {
    csv_rows("a,b\n1,2\n3\n");
    FAIL();
  } catch (const CsvError& error) {
    EXPECT_EQ(std::string(error.what()), "line 3 has 1 fields, the header has 2");
  }
  EXPECT_THROW(csv_rows("a,\"b\n"), CsvError);
}

}  // namespace
}  // namespace rayfarm
