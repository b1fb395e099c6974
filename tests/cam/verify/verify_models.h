// Programs and surfaces for the verifier's tests. Programs are text and are read back, so that lines are
// real.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "cam/verify/verify.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill::testing {

inline constexpr double kCertainty = 1e-3;  // mm
inline VerifyParams Params(double top) {
  VerifyParams p;
  p.tolerance = 0.01;
  p.finish.scallop = 0.02;
  p.stock_top_z = top;
  p.certainty = kCertainty;
  return p;
}

inline constexpr const char* kEnd = "M9\nM5\nG53 G0 Z0\nM2\n";

// Tip positions; every pass is entered from above and left upwards.
class ProgramText {
 public:
  explicit ProgramText(double clearance) : clearance_(clearance) {
    Line("G17 G21 G90 G94 G91.1");
    Line("G61");
    Line("G53 G0 Z0");
    Line("T1 M6");
    Line("S1000 M3");
    Line("G43 H1");
  }
  int Line(const std::string& text) {
    text_ += text + "\n";
    return ++lines_;
  }
  int Go(const Vec3& p) { return Line(fmt::format("G1 X{:.6f} Y{:.6f} Z{:.6f} F500", p.x(), p.y(), p.z())); }
  // Lines of the moves to points[1], points[2], ...
  std::vector<int> Pass(const std::vector<Vec3>& points) {
    Line(fmt::format("G0 X{:.6f} Y{:.6f}", points[0].x(), points[0].y()));
    Line(fmt::format("G0 Z{:.6f}", clearance_));
    Go(points[0]);
    std::vector<int> lines;
    for (std::size_t i = 1; i < points.size(); ++i) lines.push_back(Go(points[i]));
    Line(fmt::format("G0 Z{:.6f}", clearance_));
    return lines;
  }
  std::string End() const { return text_ + kEnd; }
  const std::string& text() const { return text_; }

 private:
  double clearance_;
  std::string text_;
  int lines_ = 0;
};

inline ProgramMotion Motion(const std::string& text) {
  auto motion = ReadProgram(text);
  EXPECT_TRUE(motion.ok()) << motion.status();
  return *std::move(motion);
}

inline Tool Ball(double radius) {
  Tool tool;
  tool.cutter = BallEnd{radius};
  return tool;
}

inline VerifyReport Judged(const Surface& surface, const Tool& tool, const std::string& program,
                           const VerifyParams& params, int threads = 2) {
  const RunContext run(threads);
  auto report = Verify(surface, tool, Motion(program), params, run);
  EXPECT_TRUE(report.ok()) << report.status();
  return report.ok() ? *report : VerifyReport{};
}

inline std::string Findings(const VerifyReport& report) {
  std::string text;
  for (const Diagnostic& d : report.findings) text += d.code + ": " + d.message + "\n";
  return text;
}

inline const Diagnostic* Find(const VerifyReport& report, const std::string& code) {
  for (const Diagnostic& d : report.findings) {
    if (d.code == code) return &d;
  }
  return nullptr;
}

}  // namespace patchmill::testing
