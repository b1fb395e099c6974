#include "server/handlers/get_capabilities.h"

#include <algorithm>
#include <thread>

#include "cam/post/dialect.h"
#include "core/base/status.h"
#include "server/handlers/default_values.h"
#include "server/handlers/prepare.h"
#include "server/importer.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Response = v1::GetCapabilitiesResponse;

int Cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

template <class Number>
void AddNumber(google::protobuf::RepeatedPtrField<v1::NamedNumber>* to, const char* name, Number value) {
  v1::NamedNumber& added = *to->Add();
  added.set_name(name);
  added.set_value(static_cast<double>(value));
}

void AddLimits(const ServerEnv& env, Response& response) {
  auto* const to = response.mutable_limits();
  const ServerOptions& options = env.options;
  AddNumber(to, "message_bytes", limits::kMaxMessageBytes);
  AddNumber(to, "response_bytes", limits::kMaxMessageBytes);
  AddNumber(to, "upload_bytes", limits::kMaxUploadBytes);
  AddNumber(to, "stored_model_bytes", env.store.limit_bytes());
  AddNumber(to, "request_bytes_in_flight", env.in_flight.limit_bytes());
  AddNumber(to, "message_memory_bytes", limits::kMaxFileModelBytes);
  AddNumber(to, "repeated_number_count", limits::kMaxRequestNumbers);
  AddNumber(to, "model.patch_count", limits::kMaxPatches);
  AddNumber(to, "model.control_point_count", limits::kMaxControlPoints);
  AddNumber(to, "model.finding_count", limits::kMaxModelFindings);
  AddNumber(to, "cut_length_mm", limits::kMaxCutLengthMm);
  AddNumber(to, "point_count", limits::kMaxPathPoints);
  AddNumber(to, "estimated_job_memory_bytes", env.memory.limit());
  AddNumber(to, "running_jobs", env.jobs.places());
  AddNumber(to, "waiting_jobs", options.max_queue);
  AddNumber(to, "job_threads",
            std::min(options.threads > 0 ? options.threads : Cores(), limits::kMaxThreads));
  AddNumber(to, "job_seconds", options.max_job_seconds);
  AddNumber(to, "write_seconds", options.max_write_seconds);
  AddNumber(to, "calls_of_a_connection", limits::kMaxCallsPerConnection);
}

void AddDefaults(Response& response) {
  for (const auto& [name, value] : JobDefaults()) {
    v1::NamedText& added = *response.add_defaults();
    added.set_name(name);
    added.set_value(value);
  }
}

void AddFeatures(const ServerOptions& options, bool reads_cad, Response& response) {
  const std::pair<const char*, bool> features[] = {{"cad_import", reads_cad},
                                                   {"tls", !options.cert_file.empty()},
                                                   {"client_certificates", !options.ca_file.empty()},
                                                   {"tokens", !options.tokens_file.empty()},
                                                   {"store", options.store_mib > 0},
                                                   {"disk_cache", !options.cache_dir.empty()},
                                                   {"orphans", options.orphan_seconds > 0.0},
                                                   {"metrics", !options.metrics_listen.empty()}};
  for (const auto& [name, is_on] : features) {
    if (is_on) response.add_features(name);
  }
}

void AddQuotas(const Quotas& quotas, Response& response) {
  auto* const to = response.mutable_quotas();
  if (quotas.places) AddNumber(to, "caller_jobs", *quotas.places);
  if (quotas.requests_per_minute) AddNumber(to, "caller_requests_per_minute", *quotas.requests_per_minute);
  if (quotas.job_seconds_per_day) AddNumber(to, "caller_job_seconds_per_day", *quotas.job_seconds_per_day);
  if (quotas.store_bytes) AddNumber(to, "caller_store_bytes", *quotas.store_bytes);
}

}  // namespace

absl::Status HandleGetCapabilities(const Call& call, const v1::GetCapabilitiesRequest& request,
                                   v1::GetCapabilitiesResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  response->set_server_version(ServerVersion());
  response->set_contract("patchmill.v1");
  for (const Dialect& dialect : Dialects()) response->add_dialects(dialect.name);
  for (const char* format : {"json", "pb", "bpt", "bv", "bez", "patches"})
    response->add_model_formats(format);
  const bool reads_cad = !ImporterStamp().empty();
  if (reads_cad) {
    for (const char* format : {"step", "iges"}) response->add_model_formats(format);
  }
  AddLimits(*call.env, *response);
  AddDefaults(*response);
  AddFeatures(call.env->options, reads_cad, *response);
  response->set_caller(call.caller);
  AddQuotas(call.env->callers.QuotasOf(call.caller), *response);
  return absl::OkStatus();
}

}  // namespace patchmill
