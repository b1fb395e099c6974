#include "server/answer.h"

#include <chrono>
#include <future>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/kept_answers.h"
#include "server/limits.h"
#include "server/running_jobs.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using ::testing::_;
using ::testing::ElementsAre;
using testing::StatusIs;

grpc::ByteBuffer Bytes(const std::string& text) {
  const grpc::Slice slice(text);
  return {&slice, 1};
}
std::string Text(const grpc::ByteBuffer& bytes) {
  std::vector<grpc::Slice> slices;
  EXPECT_TRUE(bytes.Dump(&slices).ok());
  std::string text;
  for (const grpc::Slice& slice : slices)
    text.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return text;
}

struct Read {
  std::vector<std::string> messages;
  absl::Status end;
};
Read ReadAll(Answer::Reader& reader) {
  Read read;
  while (true) {
    auto event = reader.Next(false, 10ms);
    if (const auto* message = std::get_if<Answer::Reader::Message>(&event)) {
      read.messages.push_back(Text(message->bytes));
    } else if (const auto* end = std::get_if<absl::Status>(&event)) {
      read.end = *end;
      return read;
    }
  }
}

class AnswerTest : public ::testing::Test {
 protected:
  MemoryLedger ledger_{1 << 30};
};

TEST_F(AnswerTest, AReaderThatComesLateGetsAllOfIt) {
  Answer answer(1000, ledger_);
  const auto first = answer.Read();
  EXPECT_TRUE(answer.Write(Bytes("a")));
  const auto second = answer.Read();
  EXPECT_TRUE(answer.Write(Bytes("b")));
  answer.End(absl::OkStatus());
  for (const auto& reader : {first.get(), second.get()}) {
    const Read read = ReadAll(*reader);
    EXPECT_THAT(read.messages, ElementsAre("a", "b"));
    EXPECT_TRUE(read.end.ok());
  }
  ASSERT_TRUE(answer.whole().has_value());
  EXPECT_EQ(answer.whole()->size(), 2u);
}

TEST_F(AnswerTest, ProgressIsTheNewestAndComesWhereNoMessageIs) {
  Answer answer(1000, ledger_);
  const auto reader = answer.Read();
  answer.SetProgress(Bytes("1"));
  answer.SetProgress(Bytes("2"));
  (void)answer.Write(Bytes("m"));
  auto event = reader->Next(true, 10ms);
  EXPECT_EQ(Text(std::get<Answer::Reader::Message>(event).bytes), "m");
  event = reader->Next(true, 10ms);
  EXPECT_EQ(Text(std::get<Answer::Reader::Progress>(event).bytes), "2");
  event = reader->Next(true, 10ms);
  EXPECT_TRUE(std::holds_alternative<Answer::Reader::Nothing>(event));
}

// The last message of a stream is the last one, whatever progress was set before it and no reader has seen.
TEST_F(AnswerTest, EndedProgressIsNotGiven) {
  Answer answer(1000, ledger_);
  const auto reader = answer.Read();
  answer.SetProgress(Bytes("1"));
  answer.EndProgress();
  (void)answer.Write(Bytes("m"));
  answer.SetProgress(Bytes("2"));
  auto event = reader->Next(true, 10ms);
  EXPECT_EQ(Text(std::get<Answer::Reader::Message>(event).bytes), "m");
  event = reader->Next(true, 10ms);
  EXPECT_TRUE(std::holds_alternative<Answer::Reader::Nothing>(event));
  answer.End(absl::OkStatus());
  event = reader->Next(true, 10ms);
  EXPECT_TRUE(std::get<absl::Status>(event).ok());
}

// Beyond what is kept, the job waits for its reader, and nothing is held for long.
TEST_F(AnswerTest, ALargeAnswerIsNoLargerThanItsReaderIsBehind) {
  Answer answer(1000, ledger_);
  auto reader = answer.Read();
  const std::string megabyte(1 << 20, 'x');
  auto job = std::async(std::launch::async, [&] {
    for (int k = 0; k < 64; ++k) {
      if (!answer.Write(Bytes(megabyte))) return k;
    }
    answer.End(absl::OkStatus());
    return 64;
  });
  std::this_thread::sleep_for(50ms);
  EXPECT_LE(ledger_.taken(), static_cast<std::int64_t>(limits::kAnswerAheadBytes) + (2 << 20));
  EXPECT_EQ(ReadAll(*reader).messages.size(), 64u);
  EXPECT_EQ(job.get(), 64);
  EXPECT_EQ(answer.Read(), nullptr);  // its beginning is gone
  EXPECT_FALSE(answer.whole().has_value());
  EXPECT_EQ(ledger_.taken(), 0);
}

TEST_F(AnswerTest, AJobWhoseReaderLeavesIsTold) {
  Answer answer(10, ledger_);
  auto reader = answer.Read();
  EXPECT_FALSE(answer.alone_since().has_value());
  auto job = std::async(std::launch::async, [&] {
    while (answer.Write(Bytes(std::string(1 << 20, 'x')))) {
    }
  });
  std::this_thread::sleep_for(20ms);
  reader.reset();
  job.get();
  EXPECT_TRUE(answer.alone_since().has_value());
}

TEST_F(AnswerTest, StoppedItEndsWithItsReason) {
  Answer answer(1000, ledger_);
  const auto reader = answer.Read();
  (void)answer.Write(Bytes("a"));
  answer.Stop(absl::UnavailableError("drains"));
  EXPECT_THAT(ReadAll(*reader).end, StatusIs(absl::StatusCode::kUnavailable, "drains"));
  EXPECT_FALSE(answer.Write(Bytes("b")));
}

class RunningJobsTest : public ::testing::Test {
 protected:
  static StoreKey Key(const std::string& digest) { return {Stored::kAnswer, "", digest}; }
  RunningJobs::Keep Keep() {
    return [this](const StoreKey& key, const std::string& from, Messages messages) {
      answers_.Put(key, from, std::move(messages));
    };
  }
  Store store_{1 << 20};
  KeptAnswers answers_{store_, nullptr};
  MemoryLedger ledger_{1 << 30};
};

TEST_F(RunningJobsTest, TheSameRequestJoinsAndItsAnswerIsKept) {
  RunningJobs jobs(Keep(), ledger_, 0.0);
  std::promise<void> go;
  std::shared_future<void> may_end = go.get_future().share();
  std::atomic<int> runs{0};
  const auto start = [&] {
    return jobs.Start({Key("k"), "", [&](Answer& answer, const std::function<bool()>&) {
                         ++runs;
                         (void)answer.Write(Bytes("a"));
                         may_end.wait();
                         (void)answer.Write(Bytes("b"));
                         return absl::OkStatus();
                       }});
  };
  auto one = start();
  auto two = start();
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_FALSE(one->joined);
  EXPECT_TRUE(two->joined);
  go.set_value();
  EXPECT_THAT(ReadAll(*one->reader).messages, ElementsAre("a", "b"));
  EXPECT_THAT(ReadAll(*two->reader).messages, ElementsAre("a", "b"));
  EXPECT_EQ(runs, 1);
  std::shared_ptr<const Messages> kept;
  for (int k = 0; k < 500 && kept == nullptr; ++k) {
    std::this_thread::sleep_for(1ms);
    kept = store_.Find<Messages>(Key("k"));
  }
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(kept->size(), 2u);
}

TEST_F(RunningJobsTest, AFailedJobIsNotKept) {
  RunningJobs jobs(Keep(), ledger_, 0.0);
  const auto started =
      jobs.Start({Key("k"), "", [](Answer&, const auto&) { return absl::InternalError("x"); }});
  EXPECT_THAT(ReadAll(*started->reader).end, StatusIs(absl::StatusCode::kInternal, "x"));
  while (jobs.running() > 0) std::this_thread::sleep_for(1ms);
  EXPECT_EQ(store_.Find<Messages>(Key("k")), nullptr);
}

absl::Status UntilGone(Answer&, const std::function<bool()>& gone) {
  while (!gone()) std::this_thread::sleep_for(1ms);
  return absl::CancelledError("gone");
}

TEST_F(RunningJobsTest, AJobWithoutReadersEndsOrGoesOnForItsTime) {
  for (const double orphan : {0.0, 0.3}) {
    RunningJobs jobs(Keep(), ledger_, orphan);
    auto started = jobs.Start({Key("k"), "", UntilGone});
    const auto left = std::chrono::steady_clock::now();
    started->reader.reset();
    while (jobs.running() > 0) std::this_thread::sleep_for(1ms);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - left;
    EXPECT_GE(took.count(), orphan);
    EXPECT_LT(took.count(), orphan + 1.0);
  }
}

TEST_F(RunningJobsTest, ALostJobIsFoundAgain) {
  RunningJobs jobs(Keep(), ledger_, 10.0);
  auto started = jobs.Start({Key("k"), "", UntilGone});
  started->reader.reset();
  const auto again = jobs.Start({Key("k"), "", UntilGone});
  EXPECT_TRUE(again->joined);
}

TEST_F(RunningJobsTest, StopAllEndsThemWithAReason) {
  RunningJobs jobs(Keep(), ledger_, 10.0);
  auto started = jobs.Start({Key("k"), "", UntilGone});
  jobs.StopAll(absl::UnavailableError("drains"));
  EXPECT_THAT(ReadAll(*started->reader).end, StatusIs(absl::StatusCode::kUnavailable, "drains"));
  while (jobs.running() > 0) std::this_thread::sleep_for(1ms);
}

}  // namespace
}  // namespace patchmill
