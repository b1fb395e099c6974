// Triangles and path blocks through the wire: they say the same as the paths, the regions and the report.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/service/embedded.h"
#include "tests/service/process.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

using testing::BumpRequest;
using testing::Embedded;

class Drawing : public ::testing::Test {
 protected:
  static v1::GenerateProgramRequest Request() {
    v1::GenerateProgramRequest request = BumpRequest();
    for (const auto output : {v1::OUTPUT_PROGRAM, v1::OUTPUT_REPORT, v1::OUTPUT_REGIONS, v1::OUTPUT_ARCS,
                              v1::OUTPUT_PATH_BLOCKS, v1::OUTPUT_TESSELLATION})
      request.add_outputs(output);
    return request;
  }
  template <class Stream>
  void Take(const Stream& stream) {
    for (const auto& event : stream.events) {
      if (event.has_path_block()) blocks_.push_back(event.path_block());
      if (event.has_mesh()) mesh_.push_back(event.mesh());
    }
  }
  double AreaOf(const v1::MeshBlock& block, int triangle) const {
    const auto corner = [&](int k) {
      const int v = block.corners(3 * triangle + k);
      return Eigen::Vector3d(block.position_mm(3 * v), block.position_mm(3 * v + 1),
                             block.position_mm(3 * v + 2));
    };
    return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }

  Embedded embedded_;
  std::vector<v1::PathBlock> blocks_;
  std::vector<v1::MeshBlock> mesh_;
};

TEST_F(Drawing, PathBlocksSayTheSameAsThePaths) {
  const Embedded::Stream stream = embedded_.Generate(Request());
  ASSERT_NE(stream.Report(), nullptr) << stream.status.error_message();
  Take(stream);
  ASSERT_FALSE(blocks_.empty());
  std::vector<double> tips, contacts;
  std::vector<int> kinds, regions, passes;
  std::vector<v1::ArcMove> arcs;
  for (const auto& event : stream.events) {
    if (event.has_paths()) {
      const v1::PathChunk& chunk = event.paths();
      tips.insert(tips.end(), chunk.tip_mm().begin(), chunk.tip_mm().end());
      contacts.insert(contacts.end(), chunk.contact_mm().begin(), chunk.contact_mm().end());
      kinds.insert(kinds.end(), chunk.tip_mm_size() / 3, chunk.kind());
      regions.insert(regions.end(), chunk.tip_mm_size() / 3, chunk.region_id());
      passes.insert(passes.end(), chunk.tip_mm_size() / 3, chunk.pass_index());
    }
    if (!event.has_arc()) continue;
    const v1::ArcMove& arc = event.arc();
    arcs.push_back(arc);
    for (const double x : {arc.tip().x_mm(), arc.tip().y_mm(), arc.tip().z_mm()}) tips.push_back(x);
    if (arc.has_contact()) {
      for (const double x : {arc.contact().x_mm(), arc.contact().y_mm(), arc.contact().z_mm()})
        contacts.push_back(x);
    }
    kinds.push_back(arc.kind());
    regions.push_back(arc.region_id());
    passes.push_back(arc.pass_index());
  }
  ASSERT_GT(arcs.size(), 10u);
  std::vector<double> block_tips, block_contacts, centers, turns;
  std::vector<int> block_kinds, block_regions, block_passes, planes;
  double seconds = 0.0;
  int lines = 0;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const v1::PathBlock& block = blocks_[k];
    for (const int count :
         {block.kind_size(), block.pass_kind_size(), block.region_id_size(), block.pass_index_size(),
          block.feed_mm_per_min_size(), block.seconds_size(), block.arc_plane_size(),
          block.contact_patch_index_size(), block.tip_mm_size() / 3})
      EXPECT_EQ(count, block.line_size());
    append(block_tips, block.tip_mm());
    append(block_contacts, block.contact_mm());
    append(block_kinds, block.kind());
    append(block_regions, block.region_id());
    append(block_passes, block.pass_index());
    append(planes, block.arc_plane());
    append(centers, block.arc_center_mm());
    append(turns, block.arc_turns());
    for (const float s : block.seconds()) seconds += s;
    for (const int line : block.line()) {
      EXPECT_GE(line, lines);
      lines = line;
    }
    for (int i = 0; i < block.line_size(); ++i)
      EXPECT_EQ(block.pass_kind(i) != v1::PASS_KIND_UNSPECIFIED, block.pass_index(i) >= 0);
  }
  EXPECT_EQ(block_tips, tips);
  EXPECT_EQ(block_contacts, contacts);
  EXPECT_EQ(block_kinds, kinds);
  EXPECT_EQ(block_regions, regions);
  EXPECT_EQ(block_passes, passes);
  EXPECT_NEAR(seconds, stream.Report()->estimated_time_s(), 0.02 * stream.Report()->estimated_time_s());
  ASSERT_EQ(turns.size(), arcs.size());
  ASSERT_EQ(centers.size(), 3 * arcs.size());
  std::size_t arc = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (planes[i] == v1::ARC_PLANE_UNSPECIFIED) continue;
    ASSERT_LT(arc, arcs.size());
    EXPECT_EQ(planes[i], arcs[arc].plane());
    EXPECT_EQ(centers[3 * arc], arcs[arc].center().x_mm());
    EXPECT_EQ(centers[3 * arc + 2], arcs[arc].center().z_mm());
    EXPECT_EQ(turns[arc] < 0.0, arcs[arc].clockwise());
    // Turned about the centre by that much, the start is the end.
    const int third = planes[i] == v1::ARC_PLANE_XY ? 2 : planes[i] == v1::ARC_PLANE_ZX ? 1 : 0;
    const int a = (third + 1) % 3, b = (third + 2) % 3;
    const auto at = [&](std::size_t move, int axis) {
      return tips[3 * move + static_cast<std::size_t>(axis)];
    };
    const double x = at(i - 1, a) - centers[3 * arc + static_cast<std::size_t>(a)];
    const double y = at(i - 1, b) - centers[3 * arc + static_cast<std::size_t>(b)];
    const double angle = 2.0 * M_PI * turns[arc];
    EXPECT_NEAR(centers[3 * arc + static_cast<std::size_t>(a)] + x * std::cos(angle) - y * std::sin(angle),
                at(i, a), 1e-6);
    EXPECT_NEAR(centers[3 * arc + static_cast<std::size_t>(b)] + x * std::sin(angle) + y * std::cos(angle),
                at(i, b), 1e-6);
    ++arc;
  }
}

// The line of a move is a line of the text that has its coordinates.
TEST_F(Drawing, TheLinesAreThoseOfTheProgram) {
  v1::GenerateProgramRequest request = Request();
  request.mutable_post()->set_arcs(false);
  *request.mutable_job() = testing::BumpJob(40.0);
  request.mutable_job()->mutable_operations(0)->set_scallop_mm(0.001);
  const Embedded::Stream stream = embedded_.Generate(request);
  Take(stream);
  ASSERT_GT(blocks_.size(), 1u);
  for (std::size_t k = 0; k + 1 < blocks_.size(); ++k) EXPECT_EQ(blocks_[k].line_size(), 4096);
  const std::string text = stream.Program();
  ASSERT_FALSE(text.empty());
  std::vector<std::string> lines = {""};
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  int compared = 0;
  for (const v1::PathBlock& block : blocks_) {
    for (int i = 0; i < block.line_size(); ++i) {
      if (block.kind(i) != v1::MOVE_KIND_CUT || block.line(i) == 0) continue;
      const std::string& line = lines.at(static_cast<std::size_t>(block.line(i) - 1));
      const std::size_t x = line.find('X');
      if (x == std::string::npos) continue;
      EXPECT_NEAR(std::stod(line.substr(x + 1)), block.tip_mm(3 * i), 1e-3) << line;
      ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

TEST_F(Drawing, TheTrianglesHaveTheRegionsAndWhatStays) {
  v1::GenerateProgramRequest request = Request();
  request.set_tessellation_chord_mm(0.002);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr);
  Take(stream);
  ASSERT_FALSE(mesh_.empty());
  const v1::RegionMap* map = nullptr;
  for (const auto& event : stream.events) {
    if (event.has_regions()) map = &event.regions();
  }
  ASSERT_NE(map, nullptr);
  std::map<int, double> areas;
  double most = 0.0, gouge = 0.0;
  for (const v1::MeshBlock& block : mesh_) {
    EXPECT_DOUBLE_EQ(block.chord_mm(), 0.002);
    const int vertices = block.position_mm_size() / 3;
    for (const int count :
         {block.normal_size() / 3, block.slope_deg_size(), block.contour_curvature_per_mm_size(),
          block.leftover_mm_size(), block.gouge_mm_size()})
      EXPECT_EQ(count, vertices);
    EXPECT_EQ(block.corners_size(), 3 * block.patch_index_size());
    EXPECT_EQ(block.region_id_size(), block.patch_index_size());
    for (const int corner : block.corners()) {
      EXPECT_GE(corner, 0);
      EXPECT_LT(corner, vertices);
    }
    for (int i = 0; i < block.region_id_size(); ++i) areas[block.region_id(i)] += AreaOf(block, i);
    for (const float left : block.leftover_mm()) most = std::max(most, static_cast<double>(left));
    for (const float deep : block.gouge_mm()) gouge = std::max(gouge, static_cast<double>(deep));
  }
  double all = 0.0;
  for (const v1::Region& region : map->regions()) all += region.area_mm2();
  for (const v1::Region& region : map->regions())
    EXPECT_NEAR(areas[region.id()], region.area_mm2(), 0.05 * region.area_mm2() + 1e-4 * all);
  const v1::Report& report = *stream.Report();
  ASSERT_EQ(report.outcome(), v1::OUTCOME_COMPLETE) << "every place is reached";
  EXPECT_LE(most, report.max_leftover_mm() + 1e-4);
  EXPECT_GT(most, 0.5 * report.max_leftover_mm());
  EXPECT_LE(gouge, report.max_gouge_mm() + 1e-4);

  // The same regions without a program.
  v1::SplitRegionsRequest split;
  *split.mutable_job() = request.job();
  split.add_outputs(v1::OUTPUT_TESSELLATION);
  split.set_tessellation_chord_mm(0.002);
  v1::SplitRegionsResponse regions;
  {
    grpc::ClientContext context;
    ASSERT_TRUE(embedded_.analysis->SplitRegions(&context, split, &regions).ok());
  }
  areas.clear();
  for (const v1::MeshBlock& block : regions.mesh()) {
    EXPECT_EQ(block.leftover_mm_size() + block.gouge_mm_size(), 0);
    for (int i = 0; i < block.region_id_size(); ++i) areas[block.region_id(i)] += AreaOf(block, i);
  }
  for (const v1::Region& region : map->regions())
    EXPECT_NEAR(areas[region.id()], region.area_mm2(), 0.05 * region.area_mm2() + 1e-4 * all);
}

TEST_F(Drawing, AProgramThatIsVerifiedIsDrawnAsItsText) {
  v1::GenerateProgramRequest request = Request();
  const Embedded::Stream made = embedded_.Generate(request);
  Take(made);
  mesh_.clear();
  blocks_.clear();
  v1::VerifyProgramRequest verify;
  *verify.mutable_source() = request.job().source();
  *verify.mutable_setup() = request.job().setup();
  *verify.add_tools() = request.job().operations(0).tool();
  verify.set_tolerance_mm(
      request.job().operations(0).tolerance_mm() > 0 ? request.job().operations(0).tolerance_mm() : 0.01);
  verify.set_program(made.Program());
  verify.add_outputs(v1::OUTPUT_TESSELLATION);
  verify.add_outputs(v1::OUTPUT_PATH_BLOCKS);
  grpc::ClientContext context;
  const auto reader = embedded_.toolpath->VerifyProgram(&context, verify);
  v1::VerifyProgramResponse event;
  double lowest = 0.0;
  v1::Report report;
  while (reader->Read(&event)) {
    if (event.has_path_block()) blocks_.push_back(event.path_block());
    if (event.has_mesh()) mesh_.push_back(event.mesh());
    if (event.has_report()) report = event.report();
  }
  ASSERT_TRUE(reader->Finish().ok());
  ASSERT_EQ(mesh_.empty(), false);
  double most = 0.0;
  for (const v1::MeshBlock& block : mesh_) {
    for (const int region : block.region_id()) EXPECT_EQ(region, -1);
    for (const float left : block.leftover_mm()) most = std::max(most, static_cast<double>(left));
  }
  EXPECT_LE(most, report.max_leftover_mm() + 1e-4);
  ASSERT_FALSE(blocks_.empty());
  lowest = blocks_[0].tip_mm(2);
  for (const v1::PathBlock& block : blocks_) {
    EXPECT_EQ(block.tip_mm_size(), 3 * block.line_size());
    EXPECT_EQ(block.region_id_size(), 0);
    for (int i = 2; i < block.tip_mm_size(); i += 3) {
      EXPECT_TRUE(std::isfinite(block.tip_mm(i)));
      lowest = std::min(lowest, block.tip_mm(i));
    }
  }
  EXPECT_NEAR(lowest, report.tip_z_min_mm(), 1e-9);
}

TEST_F(Drawing, TheTeapotTakesLessThanFiveMegabytes) {
  v1::GenerateProgramRequest request;
  v1::Job& job = *request.mutable_job();
  v1::ModelFile& file = *job.mutable_source()->mutable_file();
  file.set_format("bpt");
  file.set_content(testing::Slurp(PATCHMILL_SOURCE_DIR "/examples/teapot.bpt"));
  file.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  job.mutable_setup()->set_up(v1::UP_AXIS_Y);
  job.mutable_setup()->set_scale(50.0);
  job.mutable_setup()->mutable_stock()->set_allowance_mm(0.5);
  v1::Operation& operation = *job.add_operations();
  *operation.mutable_tool() = testing::BallTool();
  operation.set_scallop_mm(0.02);
  operation.set_tolerance_mm(0.01);
  for (const auto output : {v1::OUTPUT_PATH_BLOCKS, v1::OUTPUT_TESSELLATION}) request.add_outputs(output);
  const Embedded::Stream stream = embedded_.Generate(request);
  ASSERT_NE(stream.Report(), nullptr) << stream.status.error_message();
  Take(stream);
  std::size_t bytes = 0;
  for (const v1::PathBlock& block : blocks_) bytes += block.ByteSizeLong();
  for (const v1::MeshBlock& block : mesh_) bytes += block.ByteSizeLong();
  EXPECT_GT(bytes, 500'000u);
  EXPECT_LT(bytes, 5'000'000u);
}

// Programs on a plane of 40 x 40, whose moves are known.
class DrawnPrograms : public Drawing {
 protected:
  static constexpr const char* kStart = "G17 G21 G40 G49 G54 G80 G90 G91.1 G94\nG64 P0.003 Q0\nG53 G0 Z0\n";
  void Verify(const std::string& program, const std::vector<double>& diameters) {
    v1::VerifyProgramRequest request;
    *request.mutable_source()->mutable_model() = testing::Bump(40.0, 0.0);
    for (const double d : diameters) {
      v1::Tool& tool = *request.add_tools();
      tool.set_number(request.tools_size());
      tool.mutable_ball_end()->set_diameter_mm(d);
    }
    request.set_tolerance_mm(0.01);
    request.set_program(kStart + program);
    request.add_outputs(v1::OUTPUT_TESSELLATION);
    request.add_outputs(v1::OUTPUT_PATH_BLOCKS);
    grpc::ClientContext context;
    const auto reader = embedded_.toolpath->VerifyProgram(&context, request);
    v1::VerifyProgramResponse event;
    while (reader->Read(&event)) {
      if (event.has_path_block()) blocks_.push_back(event.path_block());
      if (event.has_mesh()) mesh_.push_back(event.mesh());
      if (event.has_report()) report_ = event.report();
    }
    const grpc::Status status = reader->Finish();
    ASSERT_TRUE(status.ok()) << status.error_message();
    ASSERT_FALSE(mesh_.empty());
  }
  // Calls check(x, y, leftover, gouge) for each vertex.
  void ForEachVertex(const std::function<void(double, double, double, double)>& check) const {
    for (const v1::MeshBlock& block : mesh_) {
      for (int i = 0; i < block.slope_deg_size(); ++i)
        check(block.position_mm(3 * i), block.position_mm(3 * i + 1), block.leftover_mm(i),
              block.gouge_mm(i));
    }
  }
  v1::Report report_;
};

TEST_F(DrawnPrograms, AGougeOnAPlaneIsSeen) {
  Verify("T1 M6\nS9000 M3\nG43 H1\nG0 X20 Y20\nZ5\nG1 Z-1 F400\nZ5\nM5\nG53 G0 Z0\nM2\n", {6.0});
  EXPECT_NEAR(report_.max_gouge_mm(), 1.0, 1e-3);
  double deepest = 0.0;
  ForEachVertex([&](double x, double y, double, double gouge) {
    deepest = std::max(deepest, gouge);
    const double beside = std::hypot(x - 20.0, y - 20.0);  // the ball's centre is 2 mm above the plane
    EXPECT_NEAR(gouge, std::max(0.0, 3.0 - std::hypot(beside, 2.0)), 1e-4);
  });
  EXPECT_GT(deepest, 0.98);
}

TEST_F(DrawnPrograms, EachToolLeavesWhatItsOwnMovesLeave) {
  Verify(
      "T1 M6\nS9000 M3\nG43 H1\nG0 X-9 Y10\nZ5\nG1 Z0 F400\nX49\nG53 G0 Z0\nM5\n"
      "T2 M6\nS9000 M3\nG43 H2\nG0 X-9 Y30\nZ5\nG1 Z0 F400\nX49\nM5\nG53 G0 Z0\nM2\n",
      {10.0, 4.0});
  ForEachVertex([&](double, double y, double leftover, double gouge) {
    const double first = std::hypot(y - 10.0, 5.0) - 5.0, second = std::hypot(y - 30.0, 2.0) - 2.0;
    EXPECT_NEAR(leftover, std::min(first, second), 1e-4) << y;
    EXPECT_NEAR(gouge, 0.0, 1e-6);
  });
}

// Run, the line with a slash gouges; skipped, it leaves what the pass leaves.
TEST_F(DrawnPrograms, OfLinesWithASlashTheWorseWayIsShown) {
  Verify("T1 M6\nS9000 M3\nG43 H1\nG0 X-9 Y10\nZ5\nG1 Z0 F400\nX49\n/X20 Z-0.5\nZ5\nM5\nG53 G0 Z0\nM2\n",
         {10.0});
  double deepest = 0.0;
  ForEachVertex([&](double, double y, double leftover, double gouge) {
    EXPECT_NEAR(leftover, std::hypot(y - 10.0, 5.0) - 5.0, 1e-4) << y;
    deepest = std::max(deepest, gouge);
  });
  EXPECT_NEAR(deepest, 0.5, 0.01);
}

TEST_F(DrawnPrograms, ThatStayAtMachineZeroHaveFinitePlaces) {
  Verify("G0 X3 Y4\nG53 G0 Z0\nM2\n", {6.0});
  ASSERT_FALSE(blocks_.empty());
  for (const v1::PathBlock& block : blocks_) {
    for (const double x : block.tip_mm()) EXPECT_TRUE(std::isfinite(x));
  }
}

}  // namespace
}  // namespace patchmill
