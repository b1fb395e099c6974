// From the end of a call, whatever ends it, to idle cores: at most 0.2 s, on the largest input of every kind
// that limits.h allows.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "patchmill/v1/analysis_service.pb.h"
#include "patchmill/v1/fairing.pb.h"
#include "server/limits.h"
#include "tests/service/daemon.h"
#include "tests/service/raw_stub.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/files.h"
#include "tests/support/fuzz.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using testing::Daemon;
using testing::RawStream;

const std::string kDaemon = PATCHMILL_BIN "/patchmilld";

double Height(double x, double y) { return 3.0 * std::sin(0.05 * x) * std::cos(0.07 * y); }

// n x n Bezier patches of that degree over a wavy sheet, 2 mm each.
v1::PatchModel Sheet(int n, int degree) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      v1::BezierPatch& bezier = *model.add_patches()->mutable_bezier();
      bezier.set_degree_u(degree);
      bezier.set_degree_v(degree);
      for (int i = 0; i <= degree; ++i) {
        for (int j = 0; j <= degree; ++j) {
          const double x = 2.0 * (a + static_cast<double>(i) / degree);
          const double y = 2.0 * (b + static_cast<double>(j) / degree);
          for (const double c : {x, y, Height(x, y)}) bezier.add_points(c);
        }
      }
    }
  }
  return model;
}

// One B-spline of `degree` with `spans` knot spans each way.
v1::PatchModel Bspline(int spans, int degree) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::BsplinePatch& bspline = *model.add_patches()->mutable_bspline();
  bspline.set_degree_u(degree);
  bspline.set_degree_v(degree);
  for (int k = -degree; k <= spans + degree; ++k) bspline.add_knots_u(std::clamp(k, 0, spans));
  *bspline.mutable_knots_v() = bspline.knots_u();
  const int points = spans + degree;
  for (int i = 0; i < points; ++i) {
    for (int j = 0; j < points; ++j) {
      for (const double c : {0.7 * i, 0.7 * j, Height(0.7 * i, 0.7 * j)}) bspline.add_points(c);
    }
  }
  return model;
}

// A curve network of n x n faces.
v1::PatchModel Network(int n) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::CurveNetwork& network = *model.mutable_network();
  for (int a = 0; a <= n; ++a) {
    for (int b = 0; b <= n; ++b) {
      v1::NetworkVertex& vertex = *network.add_vertices();
      for (const double c : {2.0 * a, 2.0 * b, Height(2.0 * a, 2.0 * b)}) vertex.add_position(c);
    }
  }
  for (int a = 0; a < n; ++a) {
    for (int b = 0; b < n; ++b) {
      v1::NetworkFace& face = *network.add_faces();
      for (const int v :
           {a * (n + 1) + b, (a + 1) * (n + 1) + b, (a + 1) * (n + 1) + b + 1, a * (n + 1) + b + 1})
        face.add_vertices(v);
    }
  }
  return model;
}

std::string Check(v1::PatchModel model, int steps = 0) {
  v1::CheckModelRequest request;
  *request.mutable_source()->mutable_model() = std::move(model);
  request.set_continuity_steps(steps);
  return request.SerializeAsString();
}

v1::GenerateProgramRequest Mill(v1::PatchModel model) {
  v1::GenerateProgramRequest request = testing::BumpRequest();
  *request.mutable_job()->mutable_source()->mutable_model() = std::move(model);
  return request;
}

// Waves of a curve or a net of measured points.
void AddPoints(int lines, int each, v1::CurvePoints& points) {
  for (int a = 0; a < lines; ++a) {
    for (int b = 0; b < each; ++b) {
      for (const double c : {1.0 * a, 1.0 * b, Height(a, b) + 0.1 * ((a * 7 + b * 13) % 11)})
        points.add_points_mm(c);
    }
  }
}

// A program of `blocks` feeds over the bump.
std::string LongProgram(int blocks) {
  std::string text = "G21 G90 G17 G40 G49 G80 G94 G54\nG64 P0.001\nT1 M6\nS12000 M3\nG0 Z30\nG0 X0 Y0\n";
  for (int k = 0; k < blocks; ++k)
    text += fmt::format("G1 X{:.3f} Y{:.3f} Z{:.3f} F1200\n", k % 12 + 0.5, k / 12 % 12 + 0.5, 6.0 + k % 3);
  return text + "G0 Z30\nM5\nM30\n";
}

constexpr char kService[] = "/patchmill.v1.";

struct Large {
  const char* name;
  std::string method;
  std::function<std::string()> request;
};

void PrintTo(const Large& large, std::ostream* out) { *out << large.name; }

const std::vector<Large>& All() {
  static const auto* const kAll = new std::vector<Large>{
      // kMaxPatches patches, nearly kMaxControlPoints control points, near kMaxMessageBytes.
      {"Patches", "ModelService/CheckModel", [] { return Check(Sheet(310, 4)); }},
      {"PatchesConverted", "ModelService/ConvertModel",
       [] {
         v1::ConvertModelRequest request;
         *request.mutable_source()->mutable_model() = Sheet(310, 4);
         return request.SerializeAsString();
       }},
      {"Json", "ModelService/CheckModel",
       [] {
         v1::CheckModelRequest request;
         std::string json;
         (void)google::protobuf::util::MessageToJsonString(Sheet(200, 4), &json);
         request.mutable_source()->mutable_file()->set_format("json");
         request.mutable_source()->mutable_file()->set_content(json);
         return request.SerializeAsString();
       }},
      // What is made of them has nearly kMaxControlPoints.
      {"HighBspline", "ModelService/CheckModel", [] { return Check(Bspline(98, 15)); }},
      {"Bspline", "ToolpathService/GenerateProgram",
       [] { return Mill(Bspline(392, 3)).SerializeAsString(); }},
      {"Joints", "ModelService/CheckModel", [] { return Check(Sheet(100, 3), limits::kMaxContinuitySteps); }},
      {"Network", "ModelService/CheckModel", [] { return Check(Network(180)); }},
      {"Lines", "AnalysisService/TraceLines",
       [] {
         v1::TraceLinesRequest request;
         *request.mutable_source()->mutable_model() = Sheet(20, 3);
         for (int k = 0; k < limits::kMaxLineFamilies; ++k) {
           v1::LineFamily& family = *request.add_families();
           family.set_kind(k % 2 == 0 ? v1::LINE_KIND_CONTOUR : v1::LINE_KIND_BRIGHTNESS);
           family.mutable_direction()->set_x_mm(0.1 * k);
           family.mutable_direction()->set_z_mm(1.0);
           family.set_count(limits::kMaxLineLevels);
         }
         return request.SerializeAsString();
       }},
      {"Evaluations", "AnalysisService/EvaluateSurface",
       [] {
         v1::EvaluateSurfaceRequest request;
         *request.mutable_source()->mutable_model() = Sheet(100, 3);
         for (int k = 0; k < limits::kMaxEvaluations; ++k) {
           request.add_patch_index(k % 10'000);
           request.add_uv(0.3);
           request.add_uv(0.6);
         }
         return request.SerializeAsString();
       }},
      {"Curve", "ModelService/FairCurve",
       [] {
         v1::FairCurveRequest request;
         AddPoints(1, static_cast<int>(limits::kMaxCurvePoints), *request.mutable_points());
         request.mutable_band()->set_z_mm(0.05);
         return request.SerializeAsString();
       }},
      {"Net", "ModelService/FairNet",
       [] {
         v1::FairNetRequest request;
         AddPoints(316, 316, *request.mutable_points());
         request.set_line_count(316);
         request.mutable_band()->set_z_mm(0.05);
         return request.SerializeAsString();
       }},
      {"Program", "ToolpathService/VerifyProgram",
       [] {
         v1::VerifyProgramRequest request;
         *request.mutable_source()->mutable_model() = testing::Bump();
         request.set_program(LongProgram(1'500'000));
         *request.add_tools() = testing::BallTool();
         request.set_tolerance_mm(0.01);
         request.set_scallop_mm(0.02);
         return request.SerializeAsString();
       }},
      {"Reach", "AnalysisService/TabulateReach",
       [] {
         v1::TabulateReachRequest request;
         *request.mutable_job() = testing::BumpJob();
         *request.mutable_job()->mutable_source()->mutable_model() = Sheet(60, 3);
         for (const double d : {3.0, 6.0, 12.0, 25.0}) request.add_tool_diameters_mm(d);
         return request.SerializeAsString();
       }},
      {"Drawing", "AnalysisService/SplitRegions",
       [] {
         v1::SplitRegionsRequest request;
         *request.mutable_job() = testing::BumpJob();
         *request.mutable_job()->mutable_source()->mutable_model() = Sheet(40, 3);
         request.add_outputs(v1::OUTPUT_PICTURE);
         request.add_outputs(v1::OUTPUT_TESSELLATION);
         request.set_tessellation_chord_mm(2e-4);
         return request.SerializeAsString();
       }},
      {"Job", "ToolpathService/GenerateProgram",
       [] {
         v1::GenerateProgramRequest request = testing::LongRequest();
         for (const v1::Output output : {v1::OUTPUT_REGIONS, v1::OUTPUT_PICTURE, v1::OUTPUT_PATH_BLOCKS,
                                         v1::OUTPUT_TESSELLATION, v1::OUTPUT_PROGRAM})
           request.add_outputs(output);
         return request.SerializeAsString();
       }},
  };
  return *kAll;
}

// The time until the process is idle for a while, s.
double SecondsToIdle(const Daemon& daemon) {
  const auto begin = Clock::now();
  auto last_busy = begin;
  double before = daemon.CpuSeconds();
  while (Clock::now() - last_busy < 120ms && Clock::now() - begin < 20s) {
    std::this_thread::sleep_for(10ms);
    const double now = daemon.CpuSeconds();
    if (now > before) last_busy = Clock::now();
    before = now;
  }
  return std::chrono::duration<double>(last_busy - begin).count();
}

class DaemonIdle : public ::testing::TestWithParam<Large> {};

TEST_P(DaemonIdle, SoonAfterACallHasEnded) {
  Daemon daemon(kDaemon, {"--store-mib", "0"});
  const std::string request = GetParam().request();
  ASSERT_LE(request.size(), limits::kMaxMessageBytes);
  grpc::ChannelArguments arguments;
  arguments.SetMaxSendMessageSize(-1);
  arguments.SetMaxReceiveMessageSize(-1);
  const auto channel =
      grpc::CreateCustomChannel(daemon.target(), grpc::InsecureChannelCredentials(), arguments);
  // A machine that does other work beside may take longer; the long tests run on one that does not.
  const double limit = testing::kSanitized ? 5.0 : testing::LongTests() ? 0.2 : 0.6;
  const int moments = testing::CountOf(3, 40);
  for (int k = 0; k < moments; ++k) {
    double least = 1e9;
    // The clock of a busy machine: the best of three counts.
    for (int attempt = 0; attempt < 3 && least > limit; ++attempt) {
      RawStream stream(channel, kService + GetParam().method);
      stream.Write(request);
      std::this_thread::sleep_for(
          std::chrono::milliseconds(60 + 1900 * (2 * k + 1) / (2 * moments) / (1 + k % 2)));
      stream.Cancel();
      stream.Finish();
      least = std::min(least, SecondsToIdle(daemon));
    }
    EXPECT_LE(least, limit) << "moment " << k;
  }
  EXPECT_TRUE(daemon.Alive());
  daemon.process().Signal(SIGTERM);
  EXPECT_EQ(daemon.process().Wait(), 0);
}

INSTANTIATE_TEST_SUITE_P(Inputs, DaemonIdle, ::testing::ValuesIn(All()),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace patchmill
