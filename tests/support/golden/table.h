// A table that people read and git compares: columns parted by tabs, a title line, rows by their first
// column.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace patchmill::testing {

struct Table {
  std::vector<std::string> columns;                      // without the first one's title, which is "job"
  std::map<std::string, std::vector<std::string>> rows;  // the first column is the key
  bool operator==(const Table&) const = default;
};

// Empty where there is no such file.
Table ReadTable(const std::string& path);
void WriteTable(const std::string& path, const Table& table);

// "feed_mm 1250.4 -> 1187.9 (-5.00 %), blocks 311 -> 290 (-6.75 %)": what differs between two rows. "no
// figure" when nothing does.
std::string Changes(const std::vector<std::string>& columns, const std::vector<std::string>& before,
                    const std::vector<std::string>& now);

}  // namespace patchmill::testing
