// `patchmill capabilities`: what a server can do, and how much of it this caller may take.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/text.h"
#include "patchmill/v1/server_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

using Texts = google::protobuf::RepeatedPtrField<std::string>;
using Rows = std::vector<std::pair<std::string, std::string>>;

std::string Joined(const Texts& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : ", ") + Printable(text);
  return all.empty() ? "none" : all;
}

void PrintRows(const Rows& rows) {
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row.first.size());
  for (const auto& row : rows) fmt::print("{:<{}}  {}\n", row.first, width, row.second);
}

void Print(const v1::GetCapabilitiesResponse& can) {
  Rows rows = {{"server version", Printable(can.server_version())},
               {"contract", Printable(can.contract())},
               {"caller", can.caller().empty() ? "callers are not told apart" : Printable(can.caller())},
               {"dialects", Joined(can.dialects())},
               {"model formats", Joined(can.model_formats())},
               {"switched on", Joined(can.features())}};
  for (const v1::NamedText& field : can.defaults())
    rows.emplace_back("default of " + Printable(field.name()), Printable(field.value()));
  for (const v1::NamedNumber& limit : can.limits())
    rows.emplace_back("limit " + Printable(limit.name()), fmt::format("{:.10g}", limit.value()));
  for (const v1::NamedNumber& quota : can.quotas())
    rows.emplace_back("quota " + Printable(quota.name()), fmt::format("{:.10g}", quota.value()));
  PrintRows(rows);
}

absl::Status Run(const CommonOptions& options, InterruptWatch& watch) {
  const absl::StatusOr<v1::GetCapabilitiesResponse> can =
      Call<v1::ServerService::Stub, v1::GetCapabilitiesRequest, v1::GetCapabilitiesResponse>(
          options, watch, &v1::ServerService::Stub::GetCapabilities, v1::GetCapabilitiesRequest());
  if (!can.ok()) return can.status();
  Print(*can);
  return absl::OkStatus();
}

}  // namespace

Command AddCapabilities(CLI::App& app) {
  auto options = std::make_shared<CommonOptions>();
  AddCommonOptions(app, *options);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
