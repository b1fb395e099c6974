// Models converted into messages: the same jobs from the message as from the file, whatever its format.
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "server/convert/model.h"
#include "server/importer.h"
#include "tests/service/embedded.h"
#include "tests/service/patchmill.h"
#include "tests/service/process.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/faced_box.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::Embedded;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Patchmill;
using testing::RpcStatusIs;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

const std::string kModels = PATCHMILL_SOURCE_DIR "/tests/models/";

const Embedded& Server() {
  static Embedded embedded;
  return embedded;
}

bool HasImporter() { return access(ImporterPath().c_str(), X_OK) == 0; }
#define NEEDS_IMPORTER() \
  if (!HasImporter()) GTEST_SKIP() << "built without Open CASCADE"

v1::ModelSource FileSource(const std::string& path) {
  v1::ModelSource source;
  source.mutable_file()->set_content(Slurp(path));
  const std::string ending = path.substr(path.rfind('.') + 1);
  if (ending != "json") source.mutable_file()->set_format(ending);
  return source;
}
v1::ModelSource MessageSource(const v1::PatchModel& model) {
  v1::ModelSource source;
  *source.mutable_model() = model;
  return source;
}

grpc::Status Convert(const v1::ConvertModelRequest& request, v1::ConvertModelResponse* response) {
  grpc::ClientContext context;
  return Server().model->ConvertModel(&context, request, response);
}
v1::ConvertModelResponse Converted(const v1::ModelSource& source) {
  v1::ConvertModelRequest request;
  *request.mutable_source() = source;
  v1::ConvertModelResponse response;
  const grpc::Status status = Convert(request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response;
}
v1::CheckModelResponse Checked(const v1::ModelSource& source) {
  v1::CheckModelRequest request;
  *request.mutable_source() = source;
  v1::CheckModelResponse response;
  const grpc::Status status = Server().Check(request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response;
}

std::vector<std::string> Codes(const google::protobuf::RepeatedPtrField<v1::Diagnostic>& findings) {
  std::vector<std::string> codes;
  for (const v1::Diagnostic& finding : findings) codes.push_back(finding.code());
  return codes;
}

// The digest covers all that a job reads of a model.
TEST(ConvertModel, TheMessageIsTheModelOfTheFile) {
  for (const char* name : {"teacup.bpt", "mixed_kinds.bv", "bicubic.bez", "toroidal_tet.patches"}) {
    SCOPED_TRACE(name);
    const v1::ConvertModelResponse converted = Converted(FileSource(kModels + name));
    EXPECT_EQ(converted.model().length_unit(), v1::LENGTH_UNIT_MILLIMETER);
    EXPECT_EQ(converted.model_sha256().size(), 32u);
    EXPECT_EQ(converted.model_sha256(), Checked(FileSource(kModels + name)).model_sha256());
    EXPECT_EQ(converted.model_sha256(), Checked(MessageSource(converted.model())).model_sha256());
    EXPECT_THAT(Codes(converted.diagnostics()), ::testing::Contains("UNIT_ASSUMED"));
  }
}

TEST(ConvertModel, InchesBecomeMillimetresAndTheScaleStays) {
  v1::PatchModel inches = testing::Bump();
  inches.set_length_unit(v1::LENGTH_UNIT_INCH);
  inches.set_join_tolerance_mm(0.25);
  const v1::ConvertModelResponse plain = Converted(MessageSource(inches));
  EXPECT_EQ(plain.model_sha256(), Checked(MessageSource(inches)).model_sha256());
  EXPECT_EQ(plain.model().patches(0).bezier().points(9 * 3 + 3), 25.4 * 8.0);
  v1::ConvertModelRequest request;
  *request.mutable_source() = MessageSource(inches);
  request.set_scale(0.5);
  v1::ConvertModelResponse half;
  ASSERT_TRUE(Convert(request, &half).ok());
  EXPECT_EQ(half.model().patches(0).bezier().points(9 * 3 + 3), 12.7 * 8.0);
  EXPECT_EQ(half.model().join_tolerance_mm(), 0.125);
  EXPECT_EQ(half.model_sha256(), Checked(MessageSource(half.model())).model_sha256());
}

TEST(ConvertModel, ANetworkStaysANetwork) {
  v1::PatchModel network;
  ASSERT_TRUE(
      google::protobuf::util::JsonStringToMessage(Slurp(PATCHMILL_SOURCE_DIR "/docs/sheet.json"), &network)
          .ok());
  ASSERT_TRUE(network.has_network());
  for (const v1::ModelSource& source :
       {MessageSource(network), FileSource(PATCHMILL_SOURCE_DIR "/docs/sheet.json")}) {
    const v1::ConvertModelResponse converted = Converted(source);
    EXPECT_EQ(converted.model().SerializeAsString(), network.SerializeAsString());
    EXPECT_EQ(converted.model_sha256(), Checked(source).model_sha256());
    v1::ConvertModelRequest scaled;
    *scaled.mutable_source() = source;
    scaled.set_scale(2.0);
    v1::ConvertModelResponse none;
    EXPECT_THAT(Convert(scaled, &none), RpcStatusIs(StatusCode::INVALID_ARGUMENT,
                                                    HasSubstr("scale = 2; must be 1 for a curve network")));
  }
}

TEST(ConvertModel, AModelThatCannotBeUsedComesBackAsFindings) {
  v1::PatchModel model = testing::Bump();
  model.mutable_patches(0)->mutable_bezier()->set_points(0, 1e300);
  const v1::ConvertModelResponse converted = Converted(MessageSource(model));
  EXPECT_FALSE(converted.has_model());
  EXPECT_TRUE(converted.model_sha256().empty());
  ASSERT_EQ(converted.diagnostics_size(), 1);
  EXPECT_EQ(converted.diagnostics(0).code(), "TOO_LARGE");
}

TEST(ConvertModel, RefusesWithTheField) {
  const auto refused = [](const v1::ConvertModelRequest& request, const std::string& text) {
    v1::ConvertModelResponse response;
    EXPECT_THAT(Convert(request, &response), RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr(text)));
  };
  v1::ConvertModelRequest request;
  refused(request, "source is missing");
  *request.mutable_source() = MessageSource(testing::Bump());
  for (const double scale : {0.0, -1.0, 1e7}) {
    request.set_scale(scale);
    refused(request, "must be in [1e-06, 1e+06]");
  }
  request.clear_scale();
  request.set_max_threads(65);
  refused(request, "max_threads = 65");
  request.clear_max_threads();
  for (const char* name : {"teacup.bpt", "../../docs/sheet.json"}) {
    *request.mutable_source() = FileSource(kModels + name);
    request.mutable_source()->mutable_file()->mutable_import_options()->set_border_tolerance_mm(1e-3);
    refused(request, "source.file.import_options.border_tolerance_mm is set; only CAD files");
  }
  *request.mutable_source() = FileSource(kModels + "cad/ring.step");
  for (const double tolerance : {0.0, -1.0, 0.1}) {
    request.mutable_source()->mutable_file()->mutable_import_options()->set_border_tolerance_mm(tolerance);
    refused(request, "source.file.import_options.border_tolerance_mm = ");
  }
}

// What a model brings along is repeated, but never an error: that would be somebody else's word.
TEST(ConvertModel, FindingsOfAModelAreRepeated) {
  v1::PatchModel model = testing::Bump();
  v1::Diagnostic& finding = *model.add_findings();
  finding.set_code("GAP");
  finding.set_severity(v1::SEVERITY_WARNING);
  finding.set_message("edges lie off their surface");
  finding.mutable_where()->set_face_id("f1");
  const v1::CheckModelResponse checked = Checked(MessageSource(model));
  EXPECT_THAT(Codes(checked.diagnostics()), ::testing::Contains("GAP"));
  EXPECT_EQ(Converted(MessageSource(model)).model().findings(0).where().face_id(), "f1");
  finding.set_severity(v1::SEVERITY_ERROR);
  EXPECT_THAT(Codes(Checked(MessageSource(model)).diagnostics()), UnorderedElementsAre("INVALID_FINDING"));
  finding.set_severity(v1::SEVERITY_INFO);
  finding.clear_code();
  EXPECT_THAT(Codes(Converted(MessageSource(model)).diagnostics()), UnorderedElementsAre("INVALID_FINDING"));
  for (int k = 0; k < 5000; ++k) model.add_findings()->set_code("GAP");
  v1::ConvertModelRequest many;
  *many.mutable_source() = MessageSource(model);
  v1::ConvertModelResponse none;
  EXPECT_THAT(Convert(many, &none),
              RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("model.finding_count")));
}

TEST(ConvertModel, ACadFileKeepsItsFacesAndFindings) {
  NEEDS_IMPORTER();
  const v1::ModelSource file = FileSource(kModels + "cad/cross.step");
  const v1::ConvertModelResponse converted = Converted(file);
  EXPECT_GT(converted.model().faces_size(), 3);
  EXPECT_EQ(converted.model_sha256(), Checked(file).model_sha256());
  const v1::CheckModelResponse again = Checked(MessageSource(converted.model()));
  EXPECT_EQ(converted.model_sha256(), again.model_sha256());
  EXPECT_THAT(Codes(again.diagnostics()), ::testing::ElementsAreArray(Codes(Checked(file).diagnostics())));
  EXPECT_THAT(Codes(again.diagnostics()), ::testing::Contains("CAD_FILE"));
}

// The curve along which two cylinders meet is no line, conic or spline of either.
TEST(ConvertModel, BordersFollowTheirToleranceAndNeedMorePatchesForIt) {
  NEEDS_IMPORTER();
  int patches = 0;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const auto imported = ImportFile(Slurp(kModels + "cad/cross.step"),
                                     {.format = "step", .border_tolerance = tolerance}, RunContext());
    ASSERT_TRUE(imported.ok()) << imported.status();
    EXPECT_LE(imported->result.report().border_error_mm(), tolerance);
    EXPECT_GT(imported->result.report().border_error_mm(), 0.0);
    EXPECT_GT(imported->result.model().patches_size(), patches);
    patches = imported->result.model().patches_size();
  }
}

// The program without the two lines that name its source.
std::string WithoutSource(const std::string& program) {
  std::string kept;
  std::istringstream in(program);
  int dropped = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find("part: ") != std::string::npos || line.find("request sha256: ") != std::string::npos) {
      ++dropped;
    } else {
      kept += line + "\n";
    }
  }
  EXPECT_EQ(dropped, 2);
  return kept;
}

Finished Mill(const std::string& model, const std::string& program) {
  return Patchmill({"mill", model, "-o", program, "--tool-diameter", "8", "--scallop", "0.2", "--tolerance",
                    "0.05", "--report", program + ".json"});
}

TEST(CliConvert, AConvertedCadFileGivesTheSameProgramInAllFormats) {
  NEEDS_IMPORTER();
  const TempDir dir;
  const std::string step = kModels + "cad/ring.step";
  ASSERT_EQ(Mill(step, dir / "step.ngc").status, 0);
  const std::string program = WithoutSource(Slurp(dir / "step.ngc"));
  for (const char* name : {"ring.pb", "ring.json"}) {
    SCOPED_TRACE(name);
    const Finished converted = Patchmill({"convert", step, dir / name});
    ASSERT_EQ(converted.status, 0) << converted.err;
    EXPECT_THAT(converted.err, HasSubstr("INFO CAD_FILE"));
    EXPECT_THAT(converted.err, HasSubstr("patches of 1 faces, in mm"));
    const Finished milled = Mill(dir / name, dir / "part.ngc");
    ASSERT_EQ(milled.status, 0) << milled.err;
    EXPECT_EQ(WithoutSource(Slurp(dir / "part.ngc")), program);
    EXPECT_THAT(Slurp(dir / "part.ngc.json"), HasSubstr("\"CAD_FILE\""));
  }
  // And from one form of the message to the other, and over a file that is there.
  ASSERT_EQ(Patchmill({"convert", dir / "ring.json", dir / "again.pb", "--quiet"}).status, 0);
  EXPECT_EQ(Slurp(dir / "again.pb"), Slurp(dir / "ring.pb"));
  ASSERT_EQ(Patchmill({"convert", dir / "ring.pb", dir / "ring.json"}).status, 0);
}

TEST(CliConvert, EveryCommandReadsWhatItWrites) {
  const TempDir dir;
  const std::string box = dir.Write("from.pb", ToProto(testing::FacedBox(10.0, 2)).SerializeAsString());
  for (const char* name : {"box.pb", "box.json"}) {
    SCOPED_TRACE(name);
    const Finished converted = Patchmill({"convert", box, dir / name, "--scale", "2"});
    ASSERT_EQ(converted.status, 0) << converted.err;
    const std::string model = dir / name;
    for (const std::vector<std::string>& command : testing::CommandsOn(model, dir, "0.05", "0.2")) {
      const Finished run = Patchmill(command);
      EXPECT_EQ(run.status, 0) << command.front() << ": " << run.err << run.out;
    }
    EXPECT_THAT(Patchmill({"check", model}).out, HasSubstr("to X 20.000 Y 20.000 Z 20.000"));
  }
}

TEST(CliConvert, SaysWhatItCannotDo) {
  const TempDir dir;
  const std::string bump = dir.Write("bump.pb", testing::Bump().SerializeAsString());
  for (const char* name : {"out.dxf", "out", "out.step.gz", "out.pb.gz"}) {
    const Finished run = Patchmill({"convert", bump, dir / name});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr(std::string(name) + "; must end in .json or .pb"));
  }
  const Finished onto = Patchmill({"convert", bump, bump});
  EXPECT_EQ(onto.status, 2);
  EXPECT_THAT(onto.err, HasSubstr("is an input; the result would replace it"));
  EXPECT_EQ(Slurp(bump), testing::Bump().SerializeAsString());
  const Finished scale = Patchmill({"convert", bump, dir / "a.pb", "--scale", "0"});
  EXPECT_EQ(scale.status, 2);
  EXPECT_THAT(scale.err, HasSubstr("--scale: scale = 0"));
  const Finished tolerance = Patchmill({"check", bump, "--border-tolerance", "0.001"});
  EXPECT_EQ(tolerance.status, 2);
  EXPECT_THAT(tolerance.err, HasSubstr("--border-tolerance: "));
  v1::PatchModel broken = testing::Bump();
  broken.mutable_patches(0)->mutable_bezier()->set_points(0, 1e300);
  const Finished faults =
      Patchmill({"convert", dir.Write("broken.pb", broken.SerializeAsString()), dir / "a.pb"});
  EXPECT_EQ(faults.status, 1);
  EXPECT_THAT(faults.err, HasSubstr("no file was written"));
  EXPECT_THAT(dir.Names(), UnorderedElementsAre("bump.pb", "broken.pb"));
}

}  // namespace
}  // namespace patchmill
