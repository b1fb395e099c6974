#include "tests/support/golden/table.h"

#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include <fmt/format.h>

namespace patchmill::testing {
namespace {

std::vector<std::string> Cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, '\t');) cells.push_back(cell);
  return cells;
}

std::optional<double> Number(const std::string& cell) {
  char* end = nullptr;
  const double number = std::strtod(cell.c_str(), &end);
  return cell.empty() || *end != '\0' ? std::nullopt : std::optional(number);
}

std::string Percent(const std::string& before, const std::string& now) {
  const std::optional<double> a = Number(before), b = Number(now);
  return a && b && *a != 0.0 ? fmt::format(" ({:+.2f} %)", 100.0 * (*b - *a) / *a) : "";
}

}  // namespace

Table ReadTable(const std::string& path) {
  Table table;
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  table.columns = Cells(line);
  if (!table.columns.empty()) table.columns.erase(table.columns.begin());
  while (std::getline(in, line)) {
    std::vector<std::string> cells = Cells(line);
    if (cells.empty()) continue;
    const std::string key = cells.front();
    cells.erase(cells.begin());
    cells.resize(table.columns.size());
    table.rows[key] = std::move(cells);
  }
  return table;
}

void WriteTable(const std::string& path, const Table& table) {
  std::ofstream out(path, std::ios::binary);
  out << "job\t" << fmt::format("{}\n", fmt::join(table.columns, "\t"));
  for (const auto& [key, cells] : table.rows)
    out << key << '\t' << fmt::format("{}\n", fmt::join(cells, "\t"));
}

std::string Changes(const std::vector<std::string>& columns, const std::vector<std::string>& before,
                    const std::vector<std::string>& now) {
  std::vector<std::string> changes;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string was = i < before.size() ? before[i] : "", is = i < now.size() ? now[i] : "";
    if (was == is) continue;
    changes.push_back(fmt::format("{} {} -> {}{}", columns[i], was, is, Percent(was, is)));
  }
  return changes.empty() ? "no figure" : fmt::format("{}", fmt::join(changes, ", "));
}

}  // namespace patchmill::testing
