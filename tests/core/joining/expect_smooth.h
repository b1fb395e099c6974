// Joined networks whose faces meet to rounding.
#pragma once

#include <gtest/gtest.h>

#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "tests/core/joining/networks.h"

namespace patchmill::testing {

// No error, so many joints, and along each of them no gap and no angle beyond rounding: 1e-11 mm and 1e-10
// rad in 300 places.
inline void ExpectSmooth(const JoinedNetwork& joined, std::size_t joints) {
  ASSERT_FALSE(HasError(joined.findings)) << Text(joined.findings);
  const auto network = BuildNetwork(joined.model);
  ASSERT_TRUE(network.ok()) << network.status();
  const auto report = MeasureContinuity(*network, 300, RunContext(1));
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->edges.size(), joints);
  for (const EdgeContinuity& e : report->edges) {
    EXPECT_LE(e.max_gap, 1e-11);
    EXPECT_LE(e.max_angle, 1e-10) << e.a.patch.value << "/" << e.b.patch.value;
  }
}

}  // namespace patchmill::testing
