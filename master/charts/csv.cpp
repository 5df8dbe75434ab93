#include "master/charts/csv.h"

namespace rayfarm {

std::string csv_line(const CsvRow& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line += ',';
    if (row[i].find_first_of(",\"\n\r") == std::string::npos) {
      line += row[i];
      continue;
    }
    line += '"';
    for (const char c : row[i]) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line + '\n';
}

std::vector<CsvRow> csv_rows(std::string_view text) {
  std::vector<CsvRow> rows;
  CsvRow row{""};
  bool is_quoted = false;
  const auto end_row = [&] {
    if (!rows.empty() && row.size() != rows[0].size())
      throw CsvError("line " + std::to_string(rows.size() + 1) + " has " + std::to_string(row.size()) +
                     " fields, the header has " + std::to_string(rows[0].size()));
    rows.push_back(std::move(row));
    row = {""};
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_quoted) {
      if (c != '"')
        row.back() += c;
      else if (i + 1 < text.size() && text[i + 1] == '"')
        row.back() += '"', ++i;
      else
        is_quoted = false;
    } else if (c == '"') {
      is_quoted = true;
    } else if (c == ',') {
      row.emplace_back();
    } else if (c == '\n') {
      end_row();
    } else if (c != '\r') {
      row.back() += c;
    }
  }
  if (is_quoted) throw CsvError("a quote is not closed");
  if (row.size() > 1 || !row[0].empty()) end_row();
  return rows;
}

}  // namespace rayfarm
