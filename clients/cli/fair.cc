#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "clients/cli/commands.h"
#include "clients/cli/fair_options.h"
#include "clients/cli/job_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

// One point a line, each number in the shortest form that reads back the same.
template <class Response>
std::string PointText(const Numbers& xyz, const std::string& ending, const Response& response) {
  const char* separator = ending == "csv" ? "," : " ";
  std::string text = response.title();
  if (text.empty() || text.front() == '#') {
    text = ending == "csv" ? (response.planar() ? "x,y" : "x,y,z") : "faired curve";
  }
  text += '\n';
  for (int i = 0; i + 2 < xyz.size(); i += 3) {
    fmt::format_to(std::back_inserter(text), "{}{}{}", xyz[i], separator, xyz[i + 1]);
    if (!response.planar()) fmt::format_to(std::back_inserter(text), "{}{}", separator, xyz[i + 2]);
    text += '\n';
  }
  return text;
}

template <class Response>
void PrintSummary(const FairOptions& options, const Response& response) {
  const Numbers& energies = response.energies();
  fmt::print(stderr, "{}: {} points, {} iterations{}\n", options.output, response.points_mm_size() / 3,
             response.iteration_count(), response.settled() || options.fit ? "" : ", not settled");
  fmt::print(stderr, "  energy    {:.6g} -> {:.6g}\n", energies[0], energies[energies.size() - 1]);
  fmt::print(stderr, "  moved     at most {:.4g}, point {}\n", response.max_moved_mm(),
             response.max_moved_point_index());
}

absl::Status CheckEnding(const char* option, const std::string& path,
                         std::initializer_list<const char*> endings) {
  if (path.empty()) return absl::OkStatus();
  for (const char* ending : endings) {
    if (Ending(path) == ending) return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      fmt::format("{} {}; must end in .{}", option, path, fmt::join(endings, ", .")));
}

absl::Status Run(const FairOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output), polyline(options.polyline), preview(options.preview);
  for (const absl::Status& ending : {CheckEnding("-o", options.output, {"csv", "dat", "json"}),
                                     CheckEnding("--polyline", options.polyline, {"csv", "dat"}),
                                     CheckEnding("--preview", options.preview, {"svg"})}) {
    if (!ending.ok()) return ending;
  }
  for (const OutputFile* file : {&output, &polyline, &preview}) {
    if (!file->wanted()) continue;
    if (const absl::Status writable = file->CheckWritable(); !writable.ok()) return writable;
  }
  absl::StatusOr<v1::FairCurveRequest> request = MakeFairRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status fits = CheckRequestSize(request->ByteSizeLong()); !fits.ok()) return fits;
  absl::StatusOr<Connection> connection = Connect(options.common);
  if (!connection.ok()) return connection.status();

  CallScope call(options.common, watch);
  v1::FairCurveResponse response;
  const grpc::Status status =
      v1::ModelService::NewStub(connection->channel)->FairCurve(call.context(), *request, &response);
  if (!status.ok()) return FromGrpc(status, options.common, watch);
  polyline.Set(PointText(response.polyline_mm(), Ending(options.polyline), response));
  preview.Set(response.picture().data());
  response.clear_picture();
  output.Set(Ending(options.output) == "json"
                 ? Json(response)
                 : PointText(response.points_mm(), Ending(options.output), response));
  for (const OutputFile* file : {&polyline, &preview, &output}) {
    if (!file->wanted()) continue;
    if (const absl::Status written = file->Commit(); !written.ok()) return written;
  }
  if (options.common.quiet) return absl::OkStatus();
  PrintSummary(options, response);
  if (response.polyline_mm_size() > 0) {
    fmt::print(stderr, "  polyline  {} points\n", response.polyline_mm_size() / 3);
  }
  return absl::OkStatus();
}

absl::Status RunNet(const FairOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output);
  if (const absl::Status ending = CheckEnding("-o", options.output, {"csv", "dat", "json"}); !ending.ok())
    return ending;
  if (const absl::Status writable = output.CheckWritable(); !writable.ok()) return writable;
  absl::StatusOr<v1::FairNetRequest> request = MakeFairNetRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status fits = CheckRequestSize(request->ByteSizeLong()); !fits.ok()) return fits;
  absl::StatusOr<Connection> connection = Connect(options.common);
  if (!connection.ok()) return connection.status();

  CallScope call(options.common, watch);
  v1::FairNetResponse response;
  const grpc::Status status =
      v1::ModelService::NewStub(connection->channel)->FairNet(call.context(), *request, &response);
  if (!status.ok()) return FromGrpc(status, options.common, watch);
  output.Set(Ending(options.output) == "json"
                 ? Json(response)
                 : PointText(response.points_mm(), Ending(options.output), response));
  if (const absl::Status written = output.Commit(); !written.ok()) return written;
  if (!options.common.quiet) PrintSummary(options, response);
  return absl::OkStatus();
}

}  // namespace

Command AddFair(CLI::App& app) {
  auto options = std::make_shared<FairOptions>();
  AddFairOptions(app, *options);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) {
    return options->net > 0 ? RunNet(*options, watch) : Run(*options, watch);
  };
}

}  // namespace patchmill::cli
