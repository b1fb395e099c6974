// GenerateProgram through the wire: the order of the stream, what each outcome carries, cancels and
// deadlines.
#include <chrono>
#include <cmath>
#include <thread>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "server/digest.h"
#include "server/limits.h"
#include "tests/service/embedded.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using ::testing::_;
using testing::BumpRequest;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::Embedded;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::RpcStatusIs;
using ::testing::StartsWith;
using Clock = std::chrono::steady_clock;
using Event = v1::GenerateProgramResponse;

v1::GenerateProgramRequest WithAllOutputs() {
  v1::GenerateProgramRequest request = BumpRequest();
  for (const auto output : {v1::OUTPUT_PROGRESS, v1::OUTPUT_REGIONS, v1::OUTPUT_PATHS, v1::OUTPUT_PROGRAM,
                            v1::OUTPUT_REPORT, v1::OUTPUT_PICTURE}) {
    request.add_outputs(output);
  }
  return request;
}

// Position of an event in the order on the wire.
int Rank(const Event& event) {
  switch (event.event_case()) {
    case Event::kAccepted:
      return 0;
    case Event::kProgress:
    case Event::kRegions:
    case Event::kPaths:
    case Event::kArc:
    case Event::kPathBlock:
    case Event::kMesh:
      return 1;
    case Event::kArtifact:
      return 2;
    case Event::kProgram:
      return 3;
    case Event::kReport:
      return 4;
    case Event::EVENT_NOT_SET:
      break;
  }
  return -1;
}

class GenerateProgram : public ::testing::Test {
 protected:
  Embedded embedded_;
};

TEST_F(GenerateProgram, StreamsInOrderAndEndsWithTheReport) {
  const Embedded::Stream stream = embedded_.Generate(WithAllOutputs());
  ASSERT_TRUE(stream.status.ok()) << stream.status.error_message();
  ASSERT_GE(stream.events.size(), 3u);
  EXPECT_TRUE(stream.events.front().has_accepted());
  int seen[5] = {};
  for (std::size_t i = 0; i < stream.events.size(); ++i) {
    ASSERT_GE(Rank(stream.events[i]), 0);
    ++seen[Rank(stream.events[i])];
    if (i > 0) {
      EXPECT_GE(Rank(stream.events[i]), Rank(stream.events[i - 1])) << i;
    }
  }
  EXPECT_EQ(seen[0], 1);
  EXPECT_GE(seen[2], 1);
  EXPECT_EQ(seen[4], 1);
  const v1::Report* report = stream.Report();
  ASSERT_NE(report, nullptr);
  ASSERT_EQ(report->outcome(), v1::OUTCOME_COMPLETE) << report->ShortDebugString();
  EXPECT_EQ(report->certificate_defect_count(), 0);
  EXPECT_GE(seen[3], 1);
}

TEST_F(GenerateProgram, ChunksAreGaplessAndTheReportKnowsSizeAndHash) {
  const Embedded::Stream stream = embedded_.Generate(WithAllOutputs());
  ASSERT_NE(stream.Report(), nullptr);
  std::int64_t program = 0, picture = 0;
  for (const Event& event : stream.events) {
    if (event.has_program()) {
      EXPECT_EQ(event.program().offset_bytes(), program);
      EXPECT_LE(event.program().data().size(), limits::kChunkBytes);
      program += static_cast<std::int64_t>(event.program().data().size());
    }
    if (event.has_artifact()) {
      EXPECT_EQ(event.artifact().name(), "preview.svg");
      EXPECT_EQ(event.artifact().offset_bytes(), picture);
      picture += static_cast<std::int64_t>(event.artifact().data().size());
    }
  }
  EXPECT_GT(picture, 0);
  EXPECT_EQ(stream.Report()->program_size_bytes(), program);
  EXPECT_EQ(stream.Report()->program_sha256(), Sha256(stream.Program()));
}

TEST_F(GenerateProgram, TheProgramHeaderCarriesTheHashOfTheRequest) {
  v1::GenerateProgramRequest request = BumpRequest();
  request.mutable_job()->set_name("bump.json");
  request.mutable_job()->mutable_operations(0)->mutable_tool()->set_cutting_data_is_default(true);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr);
  EXPECT_THAT(stream.Program(), HasSubstr(Hex(stream.events.front().accepted().request_sha256())));
  EXPECT_THAT(stream.Program(), HasSubstr("bump.json"));
  EXPECT_THAT(stream.Program(), HasSubstr("DEFAULT_CUTTING_DATA"));
}

TEST_F(GenerateProgram, AcceptedEchoesTheJobWithDefaultsFilledIn) {
  const Embedded::Stream stream = embedded_.Generate(BumpRequest());
  ASSERT_FALSE(stream.events.empty());
  const v1::Accepted& accepted = stream.events.front().accepted();
  EXPECT_EQ(accepted.request_sha256().size(), 32u);
  const v1::Operation& op = accepted.resolved_job().operations(0);
  EXPECT_NEAR(op.steep_angle_deg(), 45.0, 1e-12);
  EXPECT_EQ(op.strategy(), v1::STRATEGY_AUTO);
  EXPECT_EQ(op.heights().clearance_above_mm(), 5.0);
  // It is assumed, not stated: that makes rapids high.
  EXPECT_FALSE(accepted.resolved_job().setup().stock().has_allowance_mm());
  EXPECT_EQ(accepted.resolved_job().source().model_sha256().size(), 32u);
  EXPECT_EQ(accepted.resolved_post().dialect(), "linuxcnc");
  EXPECT_EQ(accepted.resolved_post().work_offset(), "G54");
}

TEST_F(GenerateProgram, DefaultOutputsAreProgressProgramAndReport) {
  for (const Event& event : embedded_.Generate(BumpRequest()).events) {
    EXPECT_FALSE(event.has_regions() || event.has_paths() || event.has_artifact());
  }
}

TEST_F(GenerateProgram, AReportAloneCarriesNoProgram) {
  v1::GenerateProgramRequest request = BumpRequest();
  request.add_outputs(v1::OUTPUT_REPORT);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr);
  EXPECT_EQ(stream.events.size(), 2u);
  EXPECT_GT(stream.Report()->program_size_bytes(), 0);  // it was made, and verified
}

TEST_F(GenerateProgram, PathsEndWhereTheProgramsTipBoxSays) {
  const Embedded::Stream stream = embedded_.Generate(WithAllOutputs());
  ASSERT_NE(stream.Report(), nullptr);
  double lowest = 1e9;
  int contacts = 0;
  for (const Event& event : stream.events) {
    if (!event.has_paths()) continue;
    const v1::PathChunk& chunk = event.paths();
    EXPECT_NE(chunk.kind(), v1::MOVE_KIND_UNSPECIFIED);
    EXPECT_EQ(chunk.tip_mm_size() % 3, 0);
    if (chunk.contact_mm_size() > 0) {
      EXPECT_EQ(chunk.contact_mm_size(), chunk.tip_mm_size());
    }
    EXPECT_EQ(3 * chunk.contact_patch_index_size(), chunk.contact_mm_size());
    contacts += chunk.contact_mm_size();
    for (int i = 2; i < chunk.tip_mm_size(); i += 3) lowest = std::min(lowest, chunk.tip_mm(i));
  }
  EXPECT_GT(contacts, 0);
  EXPECT_NEAR(lowest, stream.Report()->tip_z_min_mm(), 1e-3);
}

// A client that asks for arcs gets the moves of the program, one by one; another gets straight moves only.
TEST_F(GenerateProgram, ArcsComeOnlyToThoseWhoAsk) {
  v1::GenerateProgramRequest request = WithAllOutputs();
  request.mutable_job()->mutable_operations(0)->set_strategy(v1::STRATEGY_ZIGZAG);
  const Embedded::Stream straight = embedded_.Generate(request);
  for (const Event& event : straight.events) EXPECT_FALSE(event.has_arc());
  request.add_outputs(v1::OUTPUT_ARCS);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr);
  EXPECT_EQ(stream.Program(), straight.Program());
  int arcs = 0, moves = 0;
  double at[3] = {};
  for (const Event& event : stream.events) {
    if (event.has_paths()) {
      const auto& tips = event.paths().tip_mm();
      moves += tips.size() / 3;
      for (int k = 0; k < 3; ++k) at[k] = tips[tips.size() - 3 + k];
    }
    if (!event.has_arc()) continue;
    const v1::ArcMove& arc = event.arc();
    ++arcs;
    ++moves;
    EXPECT_TRUE(arc.kind() == v1::MOVE_KIND_CUT || arc.kind() == v1::MOVE_KIND_LEAD);
    EXPECT_GT(arc.feed_mm_per_min(), 0.0);
    EXPECT_EQ(arc.contact_patch_index() >= 0, arc.kind() == v1::MOVE_KIND_CUT);
    const double center[3] = {arc.center().x_mm(), arc.center().y_mm(), arc.center().z_mm()};
    const double tip[3] = {arc.tip().x_mm(), arc.tip().y_mm(), arc.tip().z_mm()};
    ASSERT_NE(arc.plane(), v1::ARC_PLANE_UNSPECIFIED);
    const int third = arc.plane() == v1::ARC_PLANE_XY ? 2 : arc.plane() == v1::ARC_PLANE_ZX ? 1 : 0;
    EXPECT_NEAR(center[third], at[third], 1e-9);
    const auto radius = [&](const double* p) {
      const int i = (third + 1) % 3, j = (third + 2) % 3;
      return std::hypot(p[i] - center[i], p[j] - center[j]);
    };
    EXPECT_NEAR(radius(at), radius(tip), 1e-6);
    for (int k = 0; k < 3; ++k) at[k] = tip[k];
  }
  EXPECT_GT(arcs, 10);
  EXPECT_EQ(moves, stream.Report()->point_count());
  EXPECT_LE(stream.Report()->arc_block_count(), arcs);
  EXPECT_GT(stream.Report()->arc_block_count(), arcs / 2);
}

TEST_F(GenerateProgram, StraightMovesOnlyWhereAsked) {
  v1::GenerateProgramRequest request = BumpRequest();
  const Embedded::Stream arcs = embedded_.Generate(request);
  ASSERT_NE(arcs.Report(), nullptr);
  EXPECT_TRUE(arcs.events.front().accepted().resolved_post().arcs());
  EXPECT_GT(arcs.Report()->arc_block_count(), 0);
  request.mutable_post()->set_arcs(false);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr);
  EXPECT_FALSE(stream.events.front().accepted().resolved_post().arcs());
  EXPECT_EQ(stream.Report()->arc_block_count(), 0);
  EXPECT_GT(stream.Report()->feed_block_count(), arcs.Report()->feed_block_count());
  EXPECT_NEAR(stream.Report()->points_per_mm() * stream.Report()->cut_length_mm(),
              stream.Report()->feed_block_count(), 1e-6);
  for (const char* word : {"\nG2 ", "\nG3 ", " I", "G18 ", "G19 "}) {
    const std::size_t moves = stream.Program().find("\nG0 X");
    EXPECT_EQ(stream.Program().find(word, moves), std::string::npos) << word;
  }
}

// Two bumps side by side: a contact lies on the patch it names, by the client's own id.
TEST_F(GenerateProgram, ContactsAndRegionsNameTheirPatches) {
  v1::GenerateProgramRequest request = WithAllOutputs();
  v1::PatchModel& model = *request.mutable_job()->mutable_source()->mutable_model();
  v1::Patch& right = *model.add_patches() = model.patches(0);
  right.set_id("right");
  for (int i = 0; i < right.bezier().points_size(); i += 3) {
    right.mutable_bezier()->set_points(i, right.bezier().points(i) + 12.0);
  }
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr);
  const v1::Accepted& accepted = stream.events.front().accepted();
  EXPECT_THAT(accepted.patch_ids(), ElementsAre("bump", "right"));
  int seen[2] = {0, 0};
  for (const Event& event : stream.events) {
    for (const v1::Region& region : event.regions().regions()) {
      EXPECT_THAT(region.patch_index(), Contains(region.inside_point().x_mm() < 12.0 ? 0 : 1));
    }
    const v1::PathChunk& chunk = event.paths();
    for (int i = 0; i < chunk.contact_patch_index_size(); ++i) {
      const double x = chunk.contact_mm(3 * i);
      const int patch = chunk.contact_patch_index(i);
      ASSERT_TRUE(patch == 0 || patch == 1);
      EXPECT_TRUE(patch == 0 ? x <= 12.0 + 1e-9 : x >= 12.0 - 1e-9) << x;
      ++seen[patch];
    }
  }
  EXPECT_GT(seen[0], 100);
  EXPECT_GT(seen[1], 100);
  for (const v1::Region& region : stream.Report()->regions()) EXPECT_EQ(region.patch_index_size(), 0);
  request.clear_outputs();
  EXPECT_EQ(embedded_.Generate(request).events.front().accepted().patch_ids_size(), 0);
}

TEST_F(GenerateProgram, SameBytesForAnyThreadCountAndRequestId) {
  v1::GenerateProgramRequest request = BumpRequest();
  request.set_max_threads(1);
  const Embedded::Stream one = embedded_.Generate(request);
  request.set_max_threads(2);
  request.set_request_id("another");
  const Embedded::Stream two = embedded_.Generate(request);
  ASSERT_FALSE(one.Program().empty());
  EXPECT_EQ(one.Program(), two.Program());
  EXPECT_EQ(one.events.front().accepted().request_sha256(), two.events.front().accepted().request_sha256());
}

TEST_F(GenerateProgram, ValidateOnlyAcceptsAndEnds) {
  v1::GenerateProgramRequest request = BumpRequest();
  request.set_validate_only(true);
  const Embedded::Stream stream = embedded_.Generate(request);
  EXPECT_TRUE(stream.status.ok());
  ASSERT_EQ(stream.events.size(), 1u);
  EXPECT_TRUE(stream.events[0].has_accepted());
  // Heights against the placed model are part of what can be checked.
  request.mutable_job()->mutable_operations(0)->mutable_heights()->set_clearance_z_mm(0.1);
  const Embedded::Stream low = embedded_.Generate(request);
  EXPECT_THAT(low.status, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("clearance_z_mm = 0.1")));
  ASSERT_EQ(testing::InfoOf(low.status).field_violations_size(), 1);
  EXPECT_EQ(testing::InfoOf(low.status).field_violations(0).field(),
            "job.operations[0].heights.clearance_z_mm");
  EXPECT_TRUE(low.events.empty());
}

TEST_F(GenerateProgram, WhenNothingCanBeReachedThereIsAReportAndNoProgram) {
  v1::GenerateProgramRequest request = WithAllOutputs();
  request.mutable_job()->mutable_operations(0)->mutable_heights()->set_floor_z_mm(50);  // all below the floor
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_TRUE(stream.status.ok()) << stream.status.error_message();
  ASSERT_NE(stream.Report(), nullptr);
  EXPECT_EQ(stream.Report()->outcome(), v1::OUTCOME_NOTHING_TO_CUT);
  EXPECT_EQ(stream.Report()->program_size_bytes(), 0);
  EXPECT_TRUE(stream.Report()->program_sha256().empty());
  for (const Event& event : stream.events) EXPECT_FALSE(event.has_program() || event.has_paths());
}

// "zeros printed, no NaN": what a front end or a script reads.
TEST_F(GenerateProgram, TheReportIsCleanJsonWithItsOwnFieldNames) {
  const Embedded::Stream stream = embedded_.Generate(BumpRequest());
  ASSERT_NE(stream.Report(), nullptr);
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string json;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(*stream.Report(), &json, options).ok());
  EXPECT_THAT(json, HasSubstr("\"max_gouge_mm\":"));
  EXPECT_THAT(json, HasSubstr("\"unreachable_area_mm2\":0"));
  EXPECT_THAT(json, HasSubstr("\"time_basis\":\"feeds only\""));
  EXPECT_THAT(json, HasSubstr("\"holder_check\":\"CHECK_STATE_NOT_CHECKED\""));
  EXPECT_THAT(json, Not(HasSubstr("NaN")));
  EXPECT_THAT(json, Not(HasSubstr("Infinity")));
  EXPECT_LT(json.find("\"outcome\""), json.find("\"max_gouge_mm\""));
  v1::Report back;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(json, &back).ok());
  EXPECT_EQ(back.SerializeAsString(), stream.Report()->SerializeAsString());
}

TEST_F(GenerateProgram, WrongRequestsEndBeforeAnythingIsSent) {
  const auto status = [&](auto spoil) {
    v1::GenerateProgramRequest request = BumpRequest();
    spoil(request);
    const Embedded::Stream stream = embedded_.Generate(request);
    EXPECT_TRUE(stream.events.empty());
    return stream.status;
  };
  EXPECT_THAT(status([](auto& r) { r.clear_job(); }), RpcStatusIs(StatusCode::INVALID_ARGUMENT, _));
  EXPECT_THAT(status([](auto& r) { r.mutable_job()->clear_source(); }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith("job.source is missing")));
  EXPECT_THAT(status([](auto& r) { r.set_request_id("a\nb"); }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith("request_id must be")));
  EXPECT_THAT(status([](auto& r) { r.set_request_id(std::string(129, 'x')); }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith("request_id must be")));
  EXPECT_THAT(status([](auto& r) { r.set_max_threads(-1); }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith("max_threads = -1")));
  EXPECT_THAT(status([](auto& r) { r.add_outputs(v1::OUTPUT_UNSPECIFIED); }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith("outputs[0] = 0")));
  EXPECT_THAT(status([](auto& r) { r.set_tessellation_chord_mm(0.0); }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, StartsWith("tessellation_chord_mm = 0; must be in")));
  EXPECT_THAT(status([](auto& r) {
                r.mutable_job()->mutable_source()->mutable_model()->mutable_patches(0)->clear_shape();
              }),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("patches[0].shape is missing")));
}

// No passes of this finish are shorter than the limit: that is known before they are made.
TEST_F(GenerateProgram, AJobThatCannotKeepALimitEndsBeforeItsPassesAreMade) {
  v1::GenerateProgramRequest request = BumpRequest(50'000.0);
  request.mutable_job()->mutable_operations(0)->set_scallop_mm(0.001);
  const auto begin = Clock::now();
  const Embedded::Stream stream = embedded_.Generate(request);
  EXPECT_THAT(stream.status, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("cut_length_mm")));
  EXPECT_THAT(stream.status.error_message(), HasSubstr("scallop"));
  EXPECT_LT(Clock::now() - begin, testing::kSanitized ? 100s : 20s);
  EXPECT_EQ(stream.Report(), nullptr);
  const v1::ErrorInfo info = testing::InfoOf(stream.status);
  EXPECT_EQ(info.reason(), "LIMIT_EXCEEDED");
  EXPECT_EQ(info.limit(), "cut_length_mm");
  EXPECT_EQ(info.limit_value(), limits::kMaxCutLengthMm);
  EXPECT_GT(info.actual_value(), info.limit_value());
}

// Two bumps at the corners of a box that would take 6 km of passes.
TEST_F(GenerateProgram, WhatAJobMightComeToRefusesNothing) {
  v1::GenerateProgramRequest request = BumpRequest();
  v1::PatchModel& model = *request.mutable_job()->mutable_source()->mutable_model();
  v1::BezierPatch& far = *model.add_patches()->mutable_bezier();
  far = model.patches(0).bezier();
  constexpr double kApart = 2600.0;  // mm
  for (int i = 0; i < far.points_size(); ++i) {
    if (i % 3 != 2) far.set_points(i, far.points(i) + kApart);
  }
  const double step = 2.0 * std::sqrt(0.05 * (6.0 - 0.05));
  ASSERT_GT(kApart * kApart / step, limits::kMaxCutLengthMm);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_TRUE(stream.status.ok()) << stream.status.error_message();
  EXPECT_EQ(stream.Report()->outcome(), v1::OUTCOME_COMPLETE);
}

// The server has let go of a cancelled job when its one place is free again.
TEST(Cancel, IsObeyedWithin200Milliseconds) {
  ServerOptions options;
  options.max_jobs = 1;
  options.max_queue = 0;
  const Embedded embedded(options);
  auto best = Clock::duration::max();
  for (int attempt = 0; attempt < 3 && best > 200ms; ++attempt) {
    grpc::ClientContext context;
    const auto reader = embedded.toolpath->GenerateProgram(&context, testing::LongRequest());
    Event event;
    ASSERT_TRUE(reader->Read(&event));
    std::this_thread::sleep_for(std::chrono::milliseconds(400 + 400 * attempt));
    const auto cancelled = Clock::now();
    context.TryCancel();
    // Refused as TOO_MANY_JOBS while the place is taken, as empty afterwards.
    const auto probe = [&] {
      v1::SplitRegionsResponse response;
      grpc::ClientContext other;
      return embedded.analysis->SplitRegions(&other, {}, &response).error_code();
    };
    while (probe() == StatusCode::RESOURCE_EXHAUSTED && Clock::now() - cancelled < 10s) {
      std::this_thread::sleep_for(2ms);
    }
    best = std::min(best, Clock::now() - cancelled);
    while (reader->Read(&event)) EXPECT_FALSE(event.has_program() || event.has_report());
    EXPECT_EQ(reader->Finish().error_code(), StatusCode::CANCELLED);
  }
  EXPECT_LT(best, testing::kSanitized ? 5s : 200ms);
}

TEST(Deadline, EndsAJobWithNothingValid) {
  const Embedded embedded;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + 700ms);
  const Embedded::Stream stream = embedded.Generate(testing::LongRequest(), &context);
  EXPECT_EQ(stream.status.error_code(), StatusCode::DEADLINE_EXCEEDED);
  EXPECT_EQ(stream.Report(), nullptr);
  EXPECT_TRUE(stream.Program().empty());
}

TEST(Deadline, TheServersOwnLimitHoldsToo) {
  ServerOptions options;
  options.max_job_seconds = 0.4;
  const Embedded embedded(options);
  const auto begin = Clock::now();
  const Embedded::Stream stream = embedded.Generate(testing::LongRequest());
  EXPECT_EQ(stream.status.error_code(), StatusCode::DEADLINE_EXCEEDED);
  EXPECT_LT(Clock::now() - begin, testing::kSanitized ? 10s : 2s);
}

TEST(ProgressTest, ComesAtLeastTwiceASecond) {
  const Embedded embedded;
  grpc::ClientContext context;
  const auto reader = embedded.toolpath->GenerateProgram(&context, testing::LongRequest());
  Event event;
  ASSERT_TRUE(reader->Read(&event));
  auto last = Clock::now();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(reader->Read(&event));
    ASSERT_TRUE(event.has_progress());
    EXPECT_GE(event.progress().fraction(), 0.0);
    EXPECT_LE(event.progress().fraction(), 1.0);
    EXPECT_LT(Clock::now() - last, 500ms);
    last = Clock::now();
  }
  context.TryCancel();
  while (reader->Read(&event)) {
  }
  reader->Finish();
}

}  // namespace
}  // namespace patchmill
