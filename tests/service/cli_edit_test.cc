// `patchmill edit` as a user meets it.
#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "patchmill/v1/model.pb.h"
#include "tests/service/process.h"

namespace patchmill {
namespace {

using ::testing::AllOf;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Slurp;
using testing::TempDir;
using ::testing::UnorderedElementsAre;

const std::string kMouse = PATCHMILL_SOURCE_DIR "/examples/mouse.json";

Finished Edit(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {PATCHMILL_BIN "/patchmill", "edit", kMouse});
  return testing::Run(arguments);
}

v1::PatchModel Model(const std::string& text) {
  v1::PatchModel model;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(text, &model).ok());
  return model;
}

TEST(CliEdit, PushesAndEditsGoIntoTheModel) {
  const TempDir out;
  out.Write("edits.json", R"({"edits": [{"turn_normal": {"vertex": 30, "direction": [0.02, 0, 1]}}]})");
  const Finished run = Edit({"--edits", out / "edits.json", "--push", "12,0.5,0.4,0.01", "-o",
                             out / "new.json", "--patches", out / "new.pb"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(out.Names(), UnorderedElementsAre("edits.json", "new.json", "new.pb"));
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("of 32 faces changed"), HasSubstr("54 joints"), HasSubstr("degrees apart")));
  v1::PatchModel edited = Model(Slurp(out / "new.json"));
  ASSERT_TRUE(edited.network().faces(12).has_push());
  EXPECT_EQ(edited.network().faces(12).push().amount(), 0.01);
  v1::PatchModel patches;
  ASSERT_TRUE(patches.ParseFromString(Slurp(out / "new.pb")));
  EXPECT_EQ(patches.patches_size(), 32);
  // The rest is what it was.
  const v1::PatchModel given = Model(Slurp(kMouse));
  *edited.mutable_network()->mutable_faces(12) = given.network().faces(12);
  *edited.mutable_network()->mutable_vertices(30) = given.network().vertices(30);
  EXPECT_EQ(edited.SerializeAsString(), given.SerializeAsString());
}

TEST(CliEdit, SaysWhatIsWrongAndWritesNothing) {
  const TempDir out;
  const auto fails = [&](std::vector<std::string> arguments, int status, const std::string& text) {
    arguments.insert(arguments.end(), {"-o", out / "new.json"});
    const Finished run = Edit(arguments);
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_THAT(run.err, HasSubstr(text));
  };
  fails({"--push", "1,2,3"}, 2, "must be FACE,U,V,AMOUNT");
  fails({"--move", "1,2,3"}, 2, "must be FACE,U,V,DISTANCE");
  fails({"--move", "12,0,0.5,1"}, 2, "edits[0].reach_goals.points[0].u gives the place (0, 0.5)");
  fails({"--push", "99,0,0,1"}, 2, "edits[0].push_face.face = 99; must be in [0, 31]");
  fails({"--edits", out / "none.json"}, 2, "none.json");
  fails({"--push", "1,7,0,1"}, 1, "INVALID_PUSH");
  EXPECT_THAT(out.Names(), IsEmpty());
  EXPECT_EQ(Edit({"-o", out / "new.txt"}).status, 2);
}

}  // namespace
}  // namespace patchmill
