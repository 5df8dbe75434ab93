// Tables as CSV text (RFC 4180: a field with a comma, quote or line end stands in quotes).
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace rayfarm {

using CsvRow = std::vector<std::string>;

/// Names its line.
struct CsvError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string csv_line(const CsvRow& row);
/// The rows, the header first. Throws CsvError unless all have as many fields as the header.
std::vector<CsvRow> csv_rows(std::string_view text);

}  // namespace rayfarm
