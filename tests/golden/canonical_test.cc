// The pinned bytes stay the same when only wording changes, and differ when anything else changes.
#include "tests/support/golden/canonical.h"

#include <gtest/gtest.h>

namespace patchmill::testing {
namespace {

constexpr char kProgram[] =
    "(part: bump)\n(tool T1)\nG17 G21\n\nG0 X1.0000 Y2.0000\nG1 Z-1.5000 F400\nX3.0000 F1200\nM2\n";

TEST(MotionBlocks, HaveNoCommentsNumbersOrBlankLines) {
  EXPECT_EQ(MotionBlocks(kProgram), "G17 G21\nG0 X1.0000 Y2.0000\nG1 Z-1.5000 F400\nX3.0000 F1200\nM2\n");
  EXPECT_EQ(MotionBlocks("N10 G17 G21\r\n N20  G0 X1.0000\tY2.0000 (rapid; first)\nN30 (only words) \n"
                         "G1 (down) Z-1.5000 F400 ; (plunge\nX3.0000 F1200\nM2"),
            MotionBlocks(kProgram));
  EXPECT_EQ(MotionBlocks(""), "");
}

TEST(MotionBlocks, EveryWordCounts) {
  for (const std::string other : {"G17 G21\nG0 X1.0000 Y2.0000\nG1 Z-1.5000 F400\nX3.0000 F1201\nM2\n",
                                  "G17 G21\nG0 X1.0000 Y2.0000\nG1 Z-1.5000 F400\nX3.0000 F1200\n",
                                  "G17 G21\nG0 X1.0000\nG0 Y2.0000\nG1 Z-1.5000 F400\nX3.0000 F1200\nM2\n"}) {
    EXPECT_NE(MotionBlocks(other), MotionBlocks(kProgram)) << other;
  }
}

v1::Report Sample() {
  v1::Report report;
  report.set_outcome(v1::OUTCOME_COMPLETE);
  report.set_cut_length_mm(12.5);
  report.set_time_basis("feeds only");
  report.set_program_size_bytes(91);
  report.set_program_sha256("ab");
  report.mutable_max_gouge_at()->set_line(6);  // G1 Z-1.5, the third block
  report.mutable_max_gouge_at()->mutable_point()->set_z_mm(-1.5);
  v1::Diagnostic& finding = *report.add_diagnostics();
  finding.set_code("SETTING_WITHOUT_EFFECT");
  finding.set_message("spirals have no effect");
  finding.mutable_where()->set_line(7);
  finding.mutable_where()->set_field("job.operations[0].contour_spirals");
  v1::Stage& stage = *report.add_stages();
  stage.set_name("passes");
  stage.set_seconds(0.25);
  return report;
}

std::string Bytes(const v1::Report& report, const std::string& program = kProgram) {
  return CanonicalBytes(CanonicalReport(report, program));
}

TEST(CanonicalReport, WordsAndTimesDoNotCount) {
  v1::Report report = Sample();
  report.set_time_basis("feeds alone");
  report.set_program_size_bytes(105);
  report.set_program_sha256("cd");
  report.mutable_diagnostics(0)->set_message("contour_spirals changes nothing here");
  report.mutable_stages(0)->set_name("plan");
  report.mutable_stages(0)->set_seconds(4.0);
  report.add_stages()->set_name("link");
  EXPECT_EQ(Bytes(report), Bytes(Sample()));
}

TEST(CanonicalReport, LinesAreCountedWithoutComments) {
  v1::Report report = Sample();
  report.mutable_max_gouge_at()->set_line(8);
  report.mutable_diagnostics(0)->mutable_where()->set_line(9);
  EXPECT_NE(Bytes(report), Bytes(Sample()));
  EXPECT_EQ(Bytes(report, std::string("(one more)\n(and another)\n") + kProgram), Bytes(Sample()));
  EXPECT_EQ(CanonicalReport(report, "").max_gouge_at().line(), 8);  // of no known program
  EXPECT_EQ(CanonicalReport(Sample(), kProgram).max_gouge_at().line(), 3);
  EXPECT_EQ(CanonicalReport(Sample(), kProgram).diagnostics(0).where().line(), 4);
}

TEST(CanonicalReport, CodesPlacesAndNumbersCount) {
  const std::vector<void (*)(v1::Report&)> changes = {
      [](v1::Report& r) { r.set_outcome(v1::OUTCOME_COMPLETE_WHERE_REACHABLE); },
      [](v1::Report& r) { r.set_cut_length_mm(12.500000000000002); },
      [](v1::Report& r) { r.mutable_max_gouge_at()->mutable_point()->set_z_mm(-1.25); },
      [](v1::Report& r) { r.mutable_diagnostics(0)->set_code("OTHER"); },
      [](v1::Report& r) { r.mutable_diagnostics(0)->set_severity(v1::SEVERITY_ERROR); },
      [](v1::Report& r) { r.mutable_diagnostics(0)->mutable_where()->set_field("job.setup"); },
      [](v1::Report& r) { *r.add_diagnostics() = r.diagnostics(0); },
      [](v1::Report& r) { r.add_regions(); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    v1::Report report = Sample();
    changes[i](report);
    EXPECT_NE(Bytes(report), Bytes(Sample())) << i;
  }
}

}  // namespace
}  // namespace patchmill::testing
