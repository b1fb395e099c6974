// The answer to a golden job, and the part of it that is pinned.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/report.pb.h"

namespace patchmill::testing {

struct GoldenAnswer {
  std::string program;    // its text; empty when there is none
  v1::RegionMap regions;  // empty when nothing was generated
  v1::Report report;
};

// SHA-256 in hexadecimal of the motion blocks, the region map and the report ("motion", "regions", "report");
// "-" for what the answer does not have.
std::map<std::string, std::string> Hashes(const GoldenAnswer& answer);

// The figures that an engineer reads first, one cell each.
std::vector<std::string> FigureColumns();
std::vector<std::string> Figures(const GoldenAnswer& answer);

// Writes what is hashed, readable, as `folder`/`name`.ngc, .regions.json and .report.json.
void WriteReadable(const GoldenAnswer& answer, const std::string& folder, const std::string& name);

}  // namespace patchmill::testing
