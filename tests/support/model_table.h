// The real parts that tests run over: tests/cam/region/split_regions_counts.txt.
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace patchmill::testing {

struct TableRow {
  std::string file, why;
  Placement placement;
  int count = 0;  // of regions
};

inline std::vector<TableRow> ModelTable() {
  std::vector<TableRow> rows;
  std::istringstream lines(ReadRepositoryFile("tests/cam/region/split_regions_counts.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    TableRow row;
    std::string up;
    std::istringstream words(line);
    words >> row.file >> row.placement.scale >> up >> row.count;
    std::getline(words >> std::ws, row.why);
    EXPECT_TRUE(words && !row.why.empty()) << line;
    row.placement.up = up == "y" ? UpAxis::kY : UpAxis::kZ;
    rows.push_back(row);
  }
  return rows;
}

// A curve network, of which the server makes patches.
inline bool IsNetwork(const TableRow& row) { return row.file.ends_with(".json"); }

// The row's model, placed; nothing for one of ../shared that is not there, and for networks.
inline std::optional<PatchModel> ModelOf(const TableRow& row) {
  const bool shared = row.file.rfind("shared/", 0) == 0;
  if (IsNetwork(row) || (shared && !ReadSharedFile(row.file.substr(7)))) return std::nullopt;
  return Place(row.placement, LoadModel(shared ? "../" + row.file : row.file));
}

}  // namespace patchmill::testing
