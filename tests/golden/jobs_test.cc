// The gate: the jobs of tests/golden/jobs are answered as hashes.tsv and figures.tsv say, on every
// instruction set, on one and two threads. PATCHMILL_UPDATE_GOLDEN=1 writes both files anew (README.md here).
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iostream>
#include <set>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "tests/service/embedded.h"
#include "tests/support/fuzz.h"
#include "tests/support/golden/covered_fields.h"
#include "tests/support/golden/golden_answer.h"
#include "tests/support/golden/job_file.h"
#include "tests/support/golden/table.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using testing::Changes;
using testing::Embedded;
using testing::FigureColumns;
using testing::Figures;
using testing::GoldenAnswer;
using testing::GoldenJob;
using testing::Hashes;
using testing::OnInstructionSet;
using testing::Table;

constexpr char kHashesFile[] = PATCHMILL_SOURCE_DIR "/tests/golden/hashes.tsv";
constexpr char kFiguresFile[] = PATCHMILL_SOURCE_DIR "/tests/golden/figures.tsv";
// Folders with the pinned and the new answers as text, for comparison.
constexpr char kPinnedFolder[] = PATCHMILL_GOLDEN_OUT "/pinned";
constexpr char kNowFolder[] = PATCHMILL_GOLDEN_OUT "/now";

// Slow builds run every job once.
#ifdef NDEBUG
constexpr bool kAllVariants = !testing::kSanitized;
#else
constexpr bool kAllVariants = false;
#endif

bool Updating() { return std::getenv("PATCHMILL_UPDATE_GOLDEN") != nullptr; }

// They are read before any test runs, because the tests are made of them.
const absl::StatusOr<std::vector<GoldenJob>>& ReadJobs() {
  static const auto* const jobs =
      new absl::StatusOr<std::vector<GoldenJob>>(testing::ReadGoldenJobs(PATCHMILL_SOURCE_DIR));
  return *jobs;
}

std::vector<GoldenJob> Jobs() { return ReadJobs().ok() ? *ReadJobs() : std::vector<GoldenJob>(); }

ServerOptions Options() {
  ServerOptions options;
  options.threads = 2;
  options.log_requests = false;
  return options;
}

// A client that names regions by their ids requests the map first.
grpc::Status NameRegions(const Embedded& server, v1::GenerateProgramRequest& request) {
  v1::Operation& operation = *request.mutable_job()->mutable_operations(0);
  const auto& overrides = operation.region_overrides();
  const bool by_id =
      std::any_of(overrides.begin(), overrides.end(), [](const auto& change) { return !change.has_at(); });
  if (!by_id) return grpc::Status::OK;
  v1::SplitRegionsRequest split;
  *split.mutable_job() = request.job();
  split.mutable_job()->mutable_operations(0)->clear_region_overrides();
  v1::SplitRegionsResponse response;
  grpc::ClientContext context;
  const grpc::Status status = server.analysis->SplitRegions(&context, split, &response);
  operation.set_regions_sha256(response.regions().regions_sha256());
  return status;
}

grpc::Status Ask(const Embedded& server, v1::GenerateProgramRequest request, GoldenAnswer& answer) {
  for (const v1::Output output : {v1::OUTPUT_REGIONS, v1::OUTPUT_PROGRAM, v1::OUTPUT_REPORT}) {
    request.add_outputs(output);
  }
  if (grpc::Status status = NameRegions(server, request); !status.ok()) return status;
  const Embedded::Stream stream = server.Generate(request);
  if (stream.Report() == nullptr) return stream.status;
  answer.program = stream.Program();
  answer.report = *stream.Report();
  for (const auto& event : stream.events) {
    if (event.has_regions()) answer.regions = event.regions();
  }
  return stream.status;
}

grpc::Status Ask(const Embedded& server, const v1::VerifyProgramRequest& request, GoldenAnswer& answer) {
  grpc::ClientContext context;
  const auto reader = server.toolpath->VerifyProgram(&context, request);
  v1::VerifyProgramResponse response;
  while (reader->Read(&response)) {
    if (response.has_report()) answer.report = response.report();
  }
  answer.program = request.program();
  return reader->Finish();
}

// Fails the test when the job fails.
GoldenAnswer Answer(const Embedded& server, const GoldenJob& job, int threads) {
  GoldenAnswer answer;
  const auto ask = [&](auto request) {
    request.set_max_threads(threads);
    return Ask(server, request, answer);
  };
  const grpc::Status status = std::visit(ask, job.request);
  EXPECT_TRUE(status.ok()) << job.name << ": " << status.error_message();
  return answer;
}

// Two processors are busy either way.
std::vector<GoldenAnswer> Answers(const std::vector<GoldenJob>& jobs, int threads) {
  const Embedded server(Options());
  std::vector<GoldenAnswer> answers(jobs.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) answers[i] = Answer(server, jobs[i], threads);
  };
  std::thread second;
  if (threads == 1) second = std::thread(work);
  work();
  if (second.joinable()) second.join();
  return answers;
}

std::string Key(const GoldenJob& job, const std::string& part) { return job.name + "/" + part; }

std::vector<std::string> Row(const Table& table, const std::string& key) {
  const auto row = table.rows.find(key);
  return row == table.rows.end() ? std::vector<std::string>() : row->second;
}

// "teapot: motion, report changed; feed_mm 1250 -> 1188 (-4.96 %)"; empty when the job is answered as pinned.
std::string Difference(const GoldenJob& job, const GoldenAnswer& answer) {
  const Table pinned = testing::ReadTable(kHashesFile);
  std::string parts;
  for (const auto& [part, hash] : Hashes(answer)) {
    if (Row(pinned, Key(job, part)) == std::vector{hash}) continue;
    parts += (parts.empty() ? "" : ", ") + part;
  }
  if (parts.empty()) return "";
  const Table figures = testing::ReadTable(kFiguresFile);
  return job.name + ": " + parts + " changed; " +
         Changes(FigureColumns(), Row(figures, job.name), Figures(answer));
}

void Compare(const GoldenJob& job, const GoldenAnswer& answer) {
  const std::string difference = Difference(job, answer);
  if (difference.empty()) return;
  WriteReadable(answer, kNowFolder, job.name);
  ADD_FAILURE() << difference << "\n  compare " << kPinnedFolder << "/" << job.name << ".* with "
                << kNowFolder;
}

void Pin(const GoldenJob& job, const GoldenAnswer& answer) {
  if (const std::string difference = Difference(job, answer); !difference.empty()) {
    std::cout << difference << "\n";
  }
  Table hashes = testing::ReadTable(kHashesFile), figures = testing::ReadTable(kFiguresFile);
  hashes.columns = {"sha256"};
  for (const auto& [part, hash] : Hashes(answer)) hashes.rows[Key(job, part)] = {hash};
  figures.columns = FigureColumns();
  figures.rows[job.name] = Figures(answer);
  testing::WriteTable(kHashesFile, hashes);
  testing::WriteTable(kFiguresFile, figures);
}

class GoldenJobs : public ::testing::TestWithParam<GoldenJob> {};

TEST_P(GoldenJobs, AreAnsweredAsPinned) {
  const GoldenJob& job = GetParam();
  const GoldenAnswer answer = Answer(Embedded(Options()), job, 2);
  if (HasFailure()) return;
  if (Updating()) Pin(job, answer);
  Compare(job, answer);
  if (HasFailure()) return;
  EXPECT_EQ(Row(testing::ReadTable(kFiguresFile), job.name), Figures(answer))
      << "figures.tsv is not of these hashes";
  WriteReadable(answer, kPinnedFolder, job.name);
}

INSTANTIATE_TEST_SUITE_P(All, GoldenJobs, ::testing::ValuesIn(Jobs()),
                         [](const auto& job) { return job.param.name; });

// After the tests above, which pin when asked to.
class GoldenVariants : public ::testing::TestWithParam<InstructionSet> {};

TEST_P(GoldenVariants, AreAnsweredAlikeByOneAndTwoThreads) {
  if (!kAllVariants) GTEST_SKIP() << "takes too long in this build";
  const OnInstructionSet on(GetParam());
  const std::vector<GoldenJob> jobs = Jobs();
  for (const int threads : {1, 2}) {
    // The tests above have two threads. Instruction sets and threads have nothing to do with each other.
    if (threads == 2 && (GetParam() == InstructionSets().front() || !testing::LongTests())) continue;
    SCOPED_TRACE(threads == 1 ? "one thread" : "two threads");
    const std::vector<GoldenAnswer> answers = Answers(jobs, threads);
    for (std::size_t i = 0; i < jobs.size(); ++i) Compare(jobs[i], answers[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenVariants, ::testing::ValuesIn(InstructionSets()),
                         [](const auto& set) { return std::string(Name(set.param)); });

TEST(GoldenFiles, HaveTheRowsOfTheJobs) {
  ASSERT_TRUE(ReadJobs().ok()) << ReadJobs().status();
  EXPECT_EQ(Jobs().size(), 35u);
  std::set<std::string> hashes, figures;
  for (const GoldenJob& job : Jobs()) {
    for (const char* part : {"motion", "regions", "report"}) hashes.insert(Key(job, part));
    figures.insert(job.name);
  }
  const auto expect_rows = [](const char* file, const std::set<std::string>& keys) {
    Table table = testing::ReadTable(file);
    if (Updating()) {
      std::erase_if(table.rows, [&](const auto& row) { return !keys.contains(row.first); });
      testing::WriteTable(file, table);
    }
    for (const auto& [key, cells] : table.rows) {
      EXPECT_TRUE(keys.contains(key)) << file << " has " << key << ", of which there is no job";
    }
  };
  expect_rows(kHashesFile, hashes);
  expect_rows(kFiguresFile, figures);
}

TEST(GoldenFiles, SetEveryOption) {
  testing::CoveredFields covered;
  for (const GoldenJob& job : Jobs()) {
    std::visit([&](const auto& request) { covered.Add(request); }, job.request);
  }
  for (const std::string& missing : covered.Missing()) {
    // The digest of a map changes with the map; tests/service/regions_test.cc sets it.
    if (missing != "Operation.regions_sha256") ADD_FAILURE() << "no job sets " << missing;
  }
}

}  // namespace
}  // namespace patchmill
