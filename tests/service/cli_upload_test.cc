// Models that are too large for one message: the command line sends them in pieces.
#include <atomic>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "patchmill/v1/model_service.grpc.pb.h"
#include "server/errors.h"
#include "tests/service/daemon.h"
#include "tests/service/patchmill.h"
#include "tests/service/requests.h"
#include "tests/support/files.h"

namespace patchmill {
namespace {

using testing::Daemon;
using testing::Finished;
using ::testing::HasSubstr;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

const std::string kBlanks(std::size_t{70} << 20, ' ');

Finished Mill(const TempDir& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"mill", folder / "mouse.json", "--scallop", "0.3", "--tolerance", "0.05",
                                    "-o",   folder / "out.ngc"};
  words.insert(words.end(), more.begin(), more.end());
  return Patchmill(words);
}

// Blanks behind the same model make the file larger than a message.
TEST(CliUpload, ALargeFileGivesTheBytesOfTheSmallOne) {
  const std::string mouse = testing::ReadRepositoryFile("examples/mouse.json");
  const TempDir small, large;
  small.Write("mouse.json", mouse);
  large.Write("mouse.json", mouse + kBlanks);
  const Finished plain = Mill(small);
  ASSERT_EQ(plain.status, 0) << plain.err;
  const std::string program = Slurp(small / "out.ngc");
  Daemon daemon(PATCHMILL_BIN "/patchmilld");
  for (const bool remote : {false, true}) {
    std::vector<std::string> where;
    if (remote) where = {"--server", daemon.target()};
    const Finished finished = Mill(large, where);
    ASSERT_EQ(finished.status, 0) << finished.err;
    EXPECT_EQ(Slurp(large / "out.ngc"), program) << remote;
    where.insert(where.begin(), {"check", large / "mouse.json"});
    const Finished checked = Patchmill(where);
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_EQ(checked.out, Patchmill({"check", small / "mouse.json"}).out) << remote;
  }
}

// The model of the stock is sent in pieces, too.
TEST(CliUpload, ALargeStockGivesTheBytesOfTheSmallOne) {
  std::string stock;
  ASSERT_TRUE(google::protobuf::util::MessageToJsonString(testing::Bump(12.0, 2.5), &stock).ok());
  const TempDir folder;
  const std::string part = folder.Write("bump.pb", testing::Bump().SerializeAsString());
  const std::string small = folder.Write("small.json", stock);
  const std::string large = folder.Write("large.json", stock + kBlanks);
  std::string program;
  for (const std::string& file : {small, large}) {
    const Finished finished =
        Patchmill({"mill", part, "-o", folder / "out.ngc", "--scallop", "0.05", "--tolerance", "0.02",
                   "--floor", "-1", "--accept-depth", "2", "--stock", "model:" + file});
    ASSERT_EQ(finished.status, 0) << finished.err;
    if (file == small) program = Slurp(folder / "out.ngc");
  }
  EXPECT_EQ(Slurp(folder / "out.ngc"), program);
}

TEST(CliUpload, ALargeFileThatIsWrongSaysWhatIsWrong) {
  const TempDir folder;
  folder.Write("mouse.json",
               R"({"lengthUnit":"LENGTH_UNIT_MILLIMETER","patches":[{"bezier":{"degreeU":99}}]})" + kBlanks);
  const Finished wrong = Mill(folder);
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("degree"));
  folder.Write("mouse.json", "{" + kBlanks);
  EXPECT_EQ(Mill(folder).status, 2);
}

// Takes uploads, and forgets the models that come first.
class Forgetful final : public v1::ModelService::Service {
 public:
  explicit Forgetful(int forgotten) : forgotten_(forgotten) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }
  std::string target() const { return "127.0.0.1:" + std::to_string(port_); }
  int uploads() const { return uploads_; }

 private:
  grpc::Status UploadModel(grpc::ServerContext*, grpc::ServerReader<v1::UploadModelRequest>* reader,
                           v1::UploadModelResponse* response) override {
    v1::UploadModelRequest message;
    while (reader->Read(&message)) {
    }
    ++uploads_;
    response->set_model_sha256(std::string(32, 'x'));
    return grpc::Status::OK;
  }
  grpc::Status CheckModel(grpc::ServerContext*, const v1::CheckModelRequest* request,
                          v1::CheckModelResponse* response) override {
    EXPECT_EQ(request->source().model_sha256(), std::string(32, 'x'));
    if (uploads_ <= forgotten_) return ToGrpcStatus(ModelNotCachedError());
    response->set_patch_count(4711);
    return grpc::Status::OK;
  }

  const int forgotten_;
  std::atomic<int> uploads_{0};
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

TEST(CliUpload, AModelThatTheServerHasForgottenIsSentAgain) {
  const TempDir folder;
  const std::string model =
      folder.Write("mouse.json", testing::ReadRepositoryFile("examples/mouse.json") + kBlanks);
  const Forgetful once(1), always(99);
  const Finished again = Patchmill({"check", model, "--server", once.target()});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("4711"));
  EXPECT_EQ(once.uploads(), 2);
  const Finished never = Patchmill({"check", model, "--server", always.target()});
  EXPECT_NE(never.status, 0);
  EXPECT_THAT(never.err, HasSubstr("does not hold"));
  EXPECT_EQ(always.uploads(), 3);
}

TEST(CliUpload, AFileBeyondTheLimitIsRefusedBeforeItIsSent) {
  const TempDir folder;
  const std::string path = folder.Write("mouse.json", "");
  std::filesystem::resize_file(path, (std::size_t{256} << 20) + 1);
  const Finished wrong = Mill(folder);
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("256 MiB"));
}

}  // namespace
}  // namespace patchmill
