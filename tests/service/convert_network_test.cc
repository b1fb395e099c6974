// Curve networks on the wire: units, faults with their places, limits, the shipped example.
#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "core/joining/continuity.h"
#include "server/convert/model.h"
#include "server/limits.h"
#include "server/model_source.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using ::testing::HasSubstr;
using testing::StatusIs;

v1::PatchModel FromJson(const std::string& text) {
  v1::PatchModel model;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &model);
  EXPECT_TRUE(status.ok()) << std::string(status.message());
  return model;
}

// A bent quad and a triangle beside it.
v1::PatchModel QuadAndTriangle() {
  return FromJson(R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "network": {
    "vertices": [{"position": [0, 0, 0]}, {"position": [10, 0, 2]}, {"position": [10, 10, 2]}, {"position": [0, 10, 1]},
                 {"position": [20, 5, 0]}],
    "edges": [{"start": 1, "end": 2, "from_normals": {"gamma": 1.2}},
              {"start": 0, "end": 1, "bezier": {"points": [0, 0, 0, 3, -1, 2, 7, -1, 2, 10, 0, 2]}}],
    "faces": [{"id": "quad", "vertices": [0, 1, 2, 3], "push": {"u": 0.4, "v": 0.6, "amount": 0.05}}, {"id": "tip", "vertices": [1, 4, 2]}]}})");
}

TEST(NetworkModel, BecomesOnePatchPerFace) {
  const auto checked = FromProto(QuadAndTriangle(), "m");
  ASSERT_TRUE(checked.ok()) << checked.status();
  ASSERT_TRUE(checked->faults.empty()) << checked->faults[0].message;
  ASSERT_EQ(checked->model.patches.size(), 2u);
  EXPECT_EQ(checked->model.patches[0].id, "quad");
  EXPECT_TRUE(std::holds_alternative<GregoryPatch>(checked->model.patches[0].shape));
  EXPECT_TRUE(std::holds_alternative<LoftTriangle>(checked->model.patches[1].shape));
  EXPECT_LE((Position(checked->model.patches[0].shape, 0.5, 0.0) - Vec3(5, -0.75, 1.75)).norm(), 1e-12);
}

// A triangle along each half of the quad's far side.
TEST(NetworkModel, AVertexMayLieOnAnEdge) {
  v1::PatchModel model = QuadAndTriangle();
  v1::CurveNetwork& network = *model.mutable_network();
  const auto parsed = [](const std::string& text, google::protobuf::Message* to) {
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(text, to).ok());
  };
  parsed(R"({"id": "tee", "on_edge": {"start": 2, "end": 1, "parameter": 0.25}})", network.add_vertices());
  parsed(R"({"id": "tip", "vertices": [1, 4, 5]})", network.mutable_faces(1));
  parsed(R"({"id": "top", "vertices": [5, 4, 2]})", network.add_faces());
  const auto checked = FromProto(model, "m");
  ASSERT_TRUE(checked.ok()) << checked.status();
  ASSERT_TRUE(checked->faults.empty()) << checked->faults[0].message;
  // Side 1 of the quad runs from vertex 1 to 2, the side of "top" from the tee to vertex 4 starts on it.
  EXPECT_LE((Position(checked->model.patches[0].shape, 1.0, 0.75) -
             Position(checked->model.patches[2].shape, 0.0, 0.0))
                .norm(),
            1e-12);
  for (const double x : {10, 5, 3}) network.mutable_vertices(5)->add_position(x);
  const auto twice = FromProto(model, "m");
  ASSERT_TRUE(twice.ok());
  ASSERT_EQ(twice->faults.size(), 1u);
  EXPECT_EQ(twice->faults[0].code, "INVALID_T_VERTEX");
  EXPECT_EQ(twice->faults[0].where.field, "network.vertices[5].position");
}

TEST(NetworkModel, UnitsScaleEverythingWithALength) {
  v1::PatchModel inches = QuadAndTriangle();
  inches.set_length_unit(v1::LENGTH_UNIT_INCH);
  const PatchModel small = FromProto(QuadAndTriangle(), "m")->model, large = FromProto(inches, "m")->model;
  ASSERT_EQ(small.patches.size(), large.patches.size());
  for (std::size_t f = 0; f < small.patches.size(); ++f) {
    for (const Vec2& q : {Vec2(0.2, 0.3), Vec2(0.5, 0), Vec2(0.1, 0.7)}) {
      EXPECT_LE((25.4 * Position(small.patches[f].shape, q.x(), q.y()) -
                 Position(large.patches[f].shape, q.x(), q.y()))
                    .norm(),
                1e-11);
    }
  }
}

// Two bent quads between three lines, joined with equal curvature by the wire's words.
v1::PatchModel TwoCells() {
  return FromJson(R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "network": {
    "vertices": [{"position": [0, 0, 0]}, {"position": [10, 1, 2]}, {"position": [20, 0, -1]},
                 {"position": [0, 10, 1]}, {"position": [11, 9, 4]}, {"position": [20, 10, 0]}],
    "edges": [{"start": 1, "end": 4, "controls": [{"face": 0, "first_derivative": [-10, 1, -1]}]}],
    "controls": [{"start": 4, "end": 1, "control": {"face": 1, "second_derivative": [1, 1, -9]}}],
    "lines": [{"vertices": [0, 1, 2]}, {"vertices": [3, 4, 5]}],
    "faces": [{"vertices": [0, 1, 4, 3], "scheme": "PATCH_SCHEME_G2_GREGORY"},
              {"vertices": [1, 2, 5, 4], "scheme": "PATCH_SCHEME_G2_GREGORY"}]}})");
}

TEST(NetworkModel, LinesAndControlsReachTheJoint) {
  for (const auto unit : {v1::LENGTH_UNIT_MILLIMETER, v1::LENGTH_UNIT_INCH}) {
    v1::PatchModel proto = TwoCells();
    proto.set_length_unit(unit);
    const double mm = *MillimetersPer(unit);
    const auto checked = FromProto(proto, "m");
    ASSERT_TRUE(checked.ok()) << checked.status();
    ASSERT_TRUE(checked->faults.empty()) << checked->faults[0].message;
    EXPECT_TRUE(checked->remarks.empty());
    const SurfaceJet a = Evaluate(checked->model.patches[0].shape, 1.0, 0.5),
                     b = Evaluate(checked->model.patches[1].shape, 0.0, 0.5);
    EXPECT_LE((a.du - mm * Vec3(10, -1, 1)).norm(), 1e-11);
    EXPECT_LE(b.du.cross(a.du).norm(), 1e-11 * a.du.squaredNorm());
    EXPECT_LE((b.duu - mm * Vec3(1, 1, -9)).norm(), 1e-10);
  }
}

// Directions have no unit; curvatures are in 1 / length_unit.
TEST(NetworkModel, EndsOfLinesReachTheEdges) {
  for (const auto unit : {v1::LENGTH_UNIT_MILLIMETER, v1::LENGTH_UNIT_INCH}) {
    v1::PatchModel proto = TwoCells();
    proto.set_length_unit(unit);
    proto.mutable_network()->clear_controls();
    proto.mutable_network()->clear_edges();
    v1::NetworkLine& line = *proto.mutable_network()->mutable_lines(0);
    for (const double x : {2.0, 0.0, 1.0}) line.add_start_direction(x);
    for (const double x : {0.0, 0.0, 0.05}) line.add_end_curvature(x);
    const double mm = *MillimetersPer(unit);
    const auto checked = FromProto(proto, "m");
    ASSERT_TRUE(checked.ok()) << checked.status();
    ASSERT_TRUE(checked->faults.empty()) << checked->faults[0].message;
    const SurfaceJet start = Evaluate(checked->model.patches[0].shape, 0.0, 0.0),
                     end = Evaluate(checked->model.patches[1].shape, 1.0, 0.0);
    EXPECT_LE(start.du.normalized().cross(Vec3(2, 0, 1).normalized()).norm(), 1e-12);
    const Vec3 along = end.du.normalized(), wanted = Vec3(0, 0, 0.05) / mm;
    const Vec3 bend = (end.duu - along * along.dot(end.duu)) / end.du.squaredNorm();
    EXPECT_LE((bend - (wanted - along * along.dot(wanted))).norm(), 1e-10 / mm);
  }
  v1::PatchModel proto = TwoCells();
  proto.mutable_network()->mutable_lines(0)->add_end_direction(1.0);
  const auto checked = FromProto(proto, "m");
  ASSERT_TRUE(checked.ok()) << checked.status();
  ASSERT_FALSE(checked->faults.empty());
  EXPECT_THAT(checked->faults[0].message,
              HasSubstr("network.lines[0].end_direction has 1 numbers; must have x y z"));
}

TEST(NetworkModel, WarningsDoNotRefuseTheModel) {
  v1::PatchModel proto = TwoCells();
  proto.mutable_network()->clear_controls();
  proto.mutable_network()->clear_edges();
  proto.mutable_network()->mutable_faces(1)->set_scheme(v1::PATCH_SCHEME_UNSPECIFIED);
  const auto checked = FromProto(proto, "m");
  ASSERT_TRUE(checked.ok()) << checked.status();
  EXPECT_TRUE(checked->faults.empty());
  ASSERT_EQ(checked->remarks.size(), 1u);
  EXPECT_EQ(checked->remarks[0].code, "TANGENT_PLANE_ONLY");
  EXPECT_EQ(checked->remarks[0].severity, Severity::kWarning);
  EXPECT_EQ(checked->remarks[0].where.field, "network.vertices[1]");
}

// One quad, one edge of a kind at a time, in millimetres and inches: the boundary passes the place it names.
struct WireEdge {
  const char* name;
  const char* json;  // of the edge from vertex 0 to 1
  double t;          // of the edge
  Vec3 place;        // there, in the model's unit
};
class WireEdges : public ::testing::TestWithParam<WireEdge> {};

TEST_P(WireEdges, ReachTheBoundary) {
  const std::string text = std::string(R"({"length_unit": "LENGTH_UNIT_MILLIMETER", "network": {
    "vertices": [{"position": [0, 0, 0], "normals": [{"direction": [-0.5, 0, 1]}]},
                 {"position": [10, 0, 0], "normals": [{"direction": [0.5, 0, 1]}]},
                 {"position": [10, 10, 2]}, {"position": [0, 10, 1]}],
    "edges": [{"start": 0, "end": 1, )") +
                           GetParam().json + R"(}],
    "faces": [{"vertices": [0, 1, 2, 3]}]}})";
  for (const auto unit : {v1::LENGTH_UNIT_MILLIMETER, v1::LENGTH_UNIT_INCH}) {
    v1::PatchModel model = FromJson(text);
    model.set_length_unit(unit);
    const auto checked = FromProto(model, "m");
    ASSERT_TRUE(checked.ok()) << checked.status();
    ASSERT_TRUE(checked->faults.empty()) << checked->faults[0].message;
    EXPECT_TRUE(checked->remarks.empty()) << checked->remarks[0].message;
    const Vec3 got = Position(checked->model.patches[0].shape, GetParam().t, 0.0);
    EXPECT_LE((got - *MillimetersPer(unit) * GetParam().place).norm(), 1e-11) << got.transpose();
  }
}

// The tangents leave at atan(1/2): an arc turns by twice that, and its middle rises by (chord/2)
// tan(angle/4).
INSTANTIATE_TEST_SUITE_P(
    All, WireEdges,
    ::testing::Values(
        WireEdge{"Arc", R"("from_normals": {"length": "TANGENT_LENGTH_ARC"})", 0.5,
                 Vec3(5, 0, 5 * std::tan(0.5 * std::atan(0.5)))},
        WireEdge{"QuarterEllipse", R"("from_normals": {"length": "TANGENT_LENGTH_QUARTER_ELLIPSE"})", 0.5,
                 Vec3(5, 0, (std::sqrt(2.0) - 1) * 2.5)},
        WireEdge{"Extremum", R"("with_extremum": {"position": [5, 0, 1.5]})", 0.5, Vec3(5, 0, 1.5)},
        WireEdge{"Slope", R"("with_slope": {"position": [5, 0, 1.5], "direction": [-2, 0, 0]})", 0.5,
                 Vec3(5, 0, 1.5)},
        WireEdge{"LedThrough", R"("led_through": {"position": [4, 1, 2], "parameter": 0.4})", 0.4,
                 Vec3(4, 1, 2)},
        WireEdge{"LedAlong",
                 R"("led_through": {"position": [4, 1, 2], "parameter": 0.4, "derivative": [9, 1, 0],
                                    "from_normals": {"gamma": 0.8}})",
                 0.4, Vec3(4, 1, 2)},
        WireEdge{"Hosaka",
                 R"("hosaka": {"origin": [0, 0, 0], "chord": [10, 0, 0], "start_derivative": [8, 0, 4],
                               "end_derivative": [8, 0, -4], "extra_terms": [0, 16, 0]})",
                 0.5, Vec3(5, 1, 1)},
        WireEdge{"PartOfASegment",
                 R"("hosaka": {"origin": [-10, 0, -4], "chord": [20, 0, 4], "start_derivative": [20, 0, 10],
                               "end_derivative": [20, 0, -6], "part_start": 0.5})",
                 0.5, Vec3(5, 0, 0.6875)},  // 3/4 of the whole
        WireEdge{"Spline",
                 R"("bspline": {"degree": 3, "knots": [0, 0, 0, 0, 1, 2, 2, 2, 2],
                                "points": [0, 0, 0, 2, 0, 1, 5, 0, 3, 8, 0, 1, 10, 0, 0]})",
                 0.5, Vec3(5, 0, 2)}),
    [](const auto& edge) { return std::string(edge.param.name); });

TEST(NetworkModel, TwistsHosakaFacesAndCutsArrive) {
  v1::PatchModel model = QuadAndTriangle();
  v1::CurveNetwork& network = *model.mutable_network();
  const auto parsed = [](const std::string& text, google::protobuf::Message* to) {
    EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(text, to).ok());
  };
  network.mutable_faces(0)->clear_push();
  parsed(R"({"start": 3, "end": 0, "start_twist": [1, 2, 3], "end_twist": [0, 0, -4]})",
         network.mutable_faces(0)->add_twists());
  for (const auto unit : {v1::LENGTH_UNIT_MILLIMETER, v1::LENGTH_UNIT_INCH}) {
    model.set_length_unit(unit);
    const auto checked = FromProto(model, "m");
    ASSERT_TRUE(checked.ok() && checked->faults.empty());
    // Side 3, a border: the tangent across it is u, and the twist as seen from vertex 3 runs down v.
    const PatchShape& shape = checked->model.patches[0].shape;
    const double h = 1e-5;
    const Vec3 from3 = (Evaluate(shape, 0, 1 - h).du - Evaluate(shape, 0, 1).du) / h,
               from0 = (Evaluate(shape, 0, h).du - Evaluate(shape, 0, 0).du) / h;
    EXPECT_LE((from3 - *MillimetersPer(unit) * Vec3(1, 2, 3)).norm(), 1e-2 * from3.norm());
    EXPECT_LE((from0 - *MillimetersPer(unit) * Vec3(0, 0, -4)).norm(), 1e-2 * from0.norm());
  }
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  network.mutable_faces(0)->clear_twists();
  network.mutable_faces(0)->set_scheme(v1::PATCH_SCHEME_HOSAKA);
  auto checked = FromProto(model, "m");
  ASSERT_TRUE(checked.ok() && checked->faults.empty()) << checked->faults[0].message;
  EXPECT_TRUE(std::holds_alternative<HosakaPatch>(checked->model.patches[0].shape));

  parsed(R"({"id": "five", "vertices": [0, 1, 4, 2, 3], "cuts": [{"start": 1, "end": 2}]})",
         network.mutable_faces(0));
  network.mutable_faces()->DeleteSubrange(1, 1);
  checked = FromProto(model, "m");
  ASSERT_TRUE(checked.ok() && checked->faults.empty()) << checked->faults[0].message;
  ASSERT_EQ(checked->model.patches.size(), 2u);
  EXPECT_EQ(checked->model.patches[1].id, "five/2");
}

TEST(NetworkModel, IsRefusedBesidePatches) {
  v1::PatchModel model = QuadAndTriangle();
  model.add_patches();
  EXPECT_THAT(FromProto(model, "m").status(), StatusIs(absl::StatusCode::kInvalidArgument,
                                                       HasSubstr("m.network is set together with patches")));
}

struct NetworkFault {
  const char* name;
  void (*spoil)(v1::CurveNetwork&);
  const char* message;
};
class NetworkFaults : public ::testing::TestWithParam<NetworkFault> {};

TEST_P(NetworkFaults, IsAFindingWithItsField) {
  v1::PatchModel model = QuadAndTriangle();
  GetParam().spoil(*model.mutable_network());
  const auto checked = FromProto(model, "m");
  ASSERT_TRUE(checked.ok()) << checked.status();
  ASSERT_FALSE(checked->faults.empty());
  EXPECT_THAT(checked->faults[0].message, HasSubstr(GetParam().message));
  EXPECT_EQ(checked->faults[0].severity, Severity::kError);
}

INSTANTIATE_TEST_SUITE_P(
    All, NetworkFaults,
    ::testing::Values(
        NetworkFault{"NoPosition", [](v1::CurveNetwork& n) { n.mutable_vertices(1)->clear_position(); },
                     "network.vertices[1].position has 0 numbers"},
        NetworkFault{"NotFinite",
                     [](v1::CurveNetwork& n) {
                       n.mutable_vertices(1)->set_position(1, std::numeric_limits<double>::quiet_NaN());
                     },
                     "network.vertices[1] position has a number that is not finite"},
        NetworkFault{"NormalShort",
                     [](v1::CurveNetwork& n) { n.mutable_vertices(1)->add_normals()->add_direction(1); },
                     "network.vertices[1].normals.direction has 1 numbers"},
        NetworkFault{"VertexOutOfRange", [](v1::CurveNetwork& n) { n.mutable_faces(1)->set_vertices(0, 9); },
                     "network.faces[1] (tip) names vertex 9"},
        NetworkFault{"VertexNegative", [](v1::CurveNetwork& n) { n.mutable_edges(0)->set_start(-1); },
                     "network.edges[0] names vertex -1"},
        NetworkFault{"FiveSides",
                     [](v1::CurveNetwork& n) {
                       auto& face = *n.mutable_faces(0);
                       face.clear_vertices();
                       for (const int v : {0, 1, 4, 2, 3}) face.add_vertices(v);
                     },
                     "has 5 sides; insert one edge, between vertices 0-4, 1-2, "},
        NetworkFault{"CurveTooLong",
                     [](v1::CurveNetwork& n) {
                       n.mutable_edges(1)->mutable_bezier()->mutable_points()->Resize(39, 0.0);
                     },
                     "network.edges[1].bezier.points has 39 numbers"},
        NetworkFault{"BsplineKnots",
                     [](v1::CurveNetwork& n) {
                       v1::BsplineCurve& curve = *n.mutable_edges(1)->mutable_bspline();
                       curve.set_degree(1);
                       for (const double x : {0., 0., 0., 10., 0., 2.}) curve.add_points(x);
                       for (const double x : {1., 0., 1., 1.}) curve.add_knots(x);
                     },
                     "network.edges[1] has knots that are not finite, decrease, or span nothing"},
        NetworkFault{
            "SchemeUnknown",
            [](v1::CurveNetwork& n) { n.mutable_faces(0)->set_scheme(static_cast<v1::PatchScheme>(77)); },
            "network.faces[0].scheme = 77"},
        NetworkFault{"SchemeWrong",
                     [](v1::CurveNetwork& n) { n.mutable_faces(1)->set_scheme(v1::PATCH_SCHEME_BROWN); },
                     "network.faces[1] (tip) its scheme is for 4 sides"},
        NetworkFault{"PushOutside",
                     [](v1::CurveNetwork& n) { n.mutable_faces(1)->mutable_push()->set_u(-0.1); },
                     "network.faces[1] (tip) is pushed at (-0.1, 0) by 0"},
        NetworkFault{"IdTooLong",
                     [](v1::CurveNetwork& n) { n.mutable_edges(0)->set_id(std::string(201, 'x')); },
                     "network.edges[0].id has 201 bytes"},
        NetworkFault{"LineOutOfRange",
                     [](v1::CurveNetwork& n) {
                       for (const int v : {0, 1, 7}) n.mutable_lines()->Add()->add_vertices(v);
                     },
                     "network.lines[0] has no spline"},
        NetworkFault{
            "ControlShort",
            [](v1::CurveNetwork& n) { n.add_controls()->mutable_control()->add_first_derivative(1); },
            "network.controls[0].control.first_derivative has 1 numbers"},
        NetworkFault{"ControlOfAGregoryQuad", [](v1::CurveNetwork& n) { n.add_controls()->set_end(1); },
                     "network.controls[0] is for faces[0], which is no G2-Gregory patch"},
        NetworkFault{"PartReversed",
                     [](v1::CurveNetwork& n) {
                       v1::HosakaCurve& curve = *n.mutable_edges(0)->mutable_hosaka();
                       for (auto* v : {curve.mutable_origin(), curve.mutable_chord(),
                                       curve.mutable_start_derivative(), curve.mutable_end_derivative()}) {
                         v->Resize(3, 1.0);
                       }
                       curve.set_part_start(0.7);
                       curve.set_part_end(0.2);
                     },
                     "network.edges[0].hosaka.part_start = 0.7, part_end = 0.2"},
        NetworkFault{"ExtraTermsTooMany",
                     [](v1::CurveNetwork& n) {
                       v1::HosakaCurve& curve = *n.mutable_edges(0)->mutable_hosaka();
                       for (auto* v : {curve.mutable_origin(), curve.mutable_chord(),
                                       curve.mutable_start_derivative(), curve.mutable_end_derivative()}) {
                         v->Resize(3, 1.0);
                       }
                       curve.mutable_extra_terms()->Resize(27, 0.0);
                     },
                     "network.edges[0].hosaka.extra_terms has 27 numbers"},
        NetworkFault{"LengthUnknown",
                     [](v1::CurveNetwork& n) {
                       n.mutable_edges(0)->mutable_from_normals()->set_length(
                           static_cast<v1::TangentLength>(9));
                     },
                     "network.edges[0].from_normals.length = 9"},
        NetworkFault{"LedWithoutParameter",
                     [](v1::CurveNetwork& n) {
                       n.mutable_edges(0)->mutable_led_through()->mutable_position()->Resize(3, 1.0);
                     },
                     "network.edges[0] is led through a point at 0"},
        NetworkFault{"TwistShort",
                     [](v1::CurveNetwork& n) { n.mutable_faces(0)->add_twists()->add_start_twist(1); },
                     "network.faces[0].twists.start_twist has 1 numbers"},
        NetworkFault{"CutAlongASide", [](v1::CurveNetwork& n) { n.mutable_faces(0)->add_cuts()->set_end(1); },
                     "network.faces[0] (quad) has cuts and is pushed"},
        NetworkFault{"NoFaces", [](v1::CurveNetwork& n) { n.clear_faces(); }, "network.faces has 0 faces"}),
    [](const auto& wrong) { return std::string(wrong.param.name); });

TEST(NetworkModel, LimitsAreCheckedByCount) {
  v1::PatchModel model = QuadAndTriangle();
  for (std::size_t i = 0; i <= limits::kMaxPatches; ++i) model.mutable_network()->add_faces();
  EXPECT_THAT(FromProto(model, "m").status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("model.patch_count = 100003")));
  model = QuadAndTriangle();
  model.mutable_network()->mutable_faces(0)->mutable_vertices()->Resize(limits::kMaxNetworkReferences + 1, 0);
  EXPECT_THAT(FromProto(model, "m").status(),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("model.network.reference_count")));
}

LoadedModel Shipped(const std::string& name) {
  std::ifstream in(PATCHMILL_SOURCE_DIR "/examples/" + name, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  v1::ModelSource source;
  source.mutable_file()->set_content(text.str());
  const auto loaded = LoadModel(source, "source");
  EXPECT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_TRUE(loaded->faults.empty()) << loaded->faults[0].message;
  return *loaded;
}

// The shipped mouse, as a file: joined to 1e-6 rad on every smooth edge, two of them along parts of a longer
// one; one loop of creases.
TEST(NetworkModel, ShippedMouseIsTangentContinuous) {
  const LoadedModel loaded = Shipped("mouse.json");
  EXPECT_EQ(loaded.model.patches.size(), 32u);
  EXPECT_EQ(std::ranges::count_if(loaded.model.patches, [](const Patch& p) { return IsTriangle(p.shape); }),
            10);
  const auto network = BuildNetwork(loaded.model);
  ASSERT_TRUE(network.ok());
  const ContinuityReport report = *MeasureContinuity(*network, 500, RunContext());
  int creases = 0, parts = 0;
  for (const EdgeContinuity& joint : report.edges) {
    EXPECT_LE(joint.max_gap, 1e-11);
    if (joint.max_angle > 1e-6) ++creases;
    if (!joint.part) continue;
    ++parts;
    EXPECT_LE(joint.max_angle, 1e-6);
  }
  EXPECT_EQ(creases, 11);
  EXPECT_EQ(parts, 2);
  EXPECT_EQ(report.edges.size(), 54u);
}

// The shipped bonnet: equal curvature at every joint, and nothing to remark.
TEST(NetworkModel, ShippedBonnetIsCurvatureContinuous) {
  const LoadedModel loaded = Shipped("bonnet.json");
  EXPECT_TRUE(loaded.remarks.empty());
  const auto network = BuildNetwork(loaded.model);
  ASSERT_TRUE(network.ok());
  const ContinuityReport report = *MeasureContinuity(*network, 200, RunContext());
  EXPECT_EQ(report.edges.size(), 12u);
  for (const EdgeContinuity& joint : report.edges) {
    EXPECT_LE(joint.max_gap, 1e-12);
    EXPECT_LE(joint.max_angle, 1e-12);
    EXPECT_LE(joint.max_curvature_gap, 1e-10 * joint.max_curvature);
  }
}

}  // namespace
}  // namespace patchmill
