#include "server/operate/metrics.h"

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include <absl/strings/numbers.h>
#include <fmt/format.h>

#include "server/operate/process_counts.h"

#ifdef PATCHMILL_PROMETHEUS
#include <prometheus/collectable.h>
#include <prometheus/counter.h>
#include <prometheus/exposer.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#endif

namespace patchmill {

#ifdef PATCHMILL_PROMETHEUS

namespace {

using prometheus::Counter;
using prometheus::Family;
using prometheus::Histogram;
using prometheus::MetricFamily;
using prometheus::MetricType;

// Figures that are read from the server at each request for them.
class Snapshot final : public prometheus::Collectable {
 public:
  explicit Snapshot(std::function<ServerFigures()> figures) : figures_(std::move(figures)) {}

  std::vector<MetricFamily> Collect() const override {
    const ServerFigures now = figures_();
    std::vector<MetricFamily> all;
    const auto add = [&all](const char* name, const char* help, MetricType type, double value) {
      prometheus::ClientMetric metric;
      (type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
      all.push_back({name, help, type, {metric}});
    };
    const auto gauge = [&add](const char* name, const char* help, double value) {
      add(name, help, MetricType::Gauge, value);
    };
    const auto counter = [&add](const char* name, const char* help, double value) {
      add(name, help, MetricType::Counter, value);
    };
    gauge("patchmill_jobs_running", "Jobs that have a place.", now.running_jobs);
    gauge("patchmill_jobs_waiting", "Jobs in the queue.", now.waiting_jobs);
    gauge("patchmill_job_places", "Most jobs at once.", now.job_places);
    gauge("patchmill_quick_calls_running", "Calls of milliseconds that have a place.",
          now.running_quick_calls);
    gauge("patchmill_quick_calls_waiting", "Calls of milliseconds in their queue.", now.waiting_quick_calls);
    gauge("patchmill_calls_open", "Calls that run, wait or send their answer.", now.open_calls);
    gauge("patchmill_resident_bytes", "Memory of the process.", now.resident_bytes);
    gauge("patchmill_memory_limit_bytes", "Limit on it (--memory-limit).", now.memory_limit_bytes);
    gauge("patchmill_granted_bytes", "Memory that calls were granted.", now.granted_bytes);
    gauge("patchmill_granted_limit_bytes", "Most memory that calls may be granted.", now.granted_limit_bytes);
    gauge("patchmill_store_bytes", "Models, CAD files and answers that are kept.", now.store_bytes);
    gauge("patchmill_store_limit_bytes", "Limit on them (--store-mib).", now.store_limit_bytes);
    gauge("patchmill_store_values", "Number of them.", now.store_values);
    counter("patchmill_store_hits_total", "Look-ups that found their value.", now.store_hits);
    counter("patchmill_store_misses_total", "Look-ups that did not.", now.store_misses);
    counter("patchmill_store_forgotten_total", "Values forgotten for want of room.", now.store_forgotten);
    gauge("patchmill_draining", "1 while the server ends.", now.draining ? 1.0 : 0.0);
    gauge("patchmill_certificate_until_seconds",
          "When the certificate of the server expires, seconds since 1970; 0 without TLS.",
          now.certificate_until);
    counter("patchmill_import_failures_total", "CAD files that could not be read.",
            static_cast<double>(Counts().failed_imports.load()));
    counter("patchmill_tls_failures_total", "Handshakes of TLS that failed.",
            static_cast<double>(Counts().failed_handshakes.load()));
    return all;
  }

 private:
  const std::function<ServerFigures()> figures_;
};

}  // namespace

struct Metrics::Parts {
  std::shared_ptr<prometheus::Registry> registry = std::make_shared<prometheus::Registry>();
  Family<Counter>& calls = prometheus::BuildCounter()
                               .Name("patchmill_calls_total")
                               .Help("Calls that have ended, by method and status code.")
                               .Register(*registry);
  Family<Counter>& refusals = prometheus::BuildCounter()
                                  .Name("patchmill_refusals_total")
                                  .Help("Calls that ended with an error, by the reason of its ErrorInfo.")
                                  .Register(*registry);
  Family<Histogram>& seconds = prometheus::BuildHistogram()
                                   .Name("patchmill_call_seconds")
                                   .Help("Time from the start of a call to its end, by method.")
                                   .Register(*registry);
  Family<Counter>& stages = prometheus::BuildCounter()
                                .Name("patchmill_stage_seconds_total")
                                .Help("Time of jobs by stage, summed.")
                                .Register(*registry);
  Counter& defects = prometheus::BuildCounter()
                         .Name("patchmill_certificate_defects_total")
                         .Help("Height certificates of jobs that did not close; each is a fault to report.")
                         .Register(*registry)
                         .Add({});
  Counter& failed_tokens = prometheus::BuildCounter()
                               .Name("patchmill_token_failures_total")
                               .Help("Calls without a token that counts.")
                               .Register(*registry)
                               .Add({});
  std::shared_ptr<Snapshot> snapshot;
  std::unique_ptr<prometheus::Exposer> exposer;
};

Metrics::Metrics() : parts_(std::make_unique<Parts>()) {}
Metrics::~Metrics() = default;

void Metrics::CallEnded(std::string_view method, const absl::Status& status, std::string_view reason,
                        double seconds) {
  const std::string name(method);
  parts_->calls.Add({{"method", name}, {"code", absl::StatusCodeToString(status.code())}}).Increment();
  if (!reason.empty()) parts_->refusals.Add({{"reason", std::string(reason)}}).Increment();
  if (absl::IsUnauthenticated(status)) parts_->failed_tokens.Increment();
  parts_->seconds
      .Add({{"method", name}},
           Histogram::BucketBoundaries{0.005, 0.02, 0.1, 0.5, 2.0, 10.0, 60.0, 300.0, 1800.0})
      .Observe(seconds);
}

void Metrics::StageTook(std::string_view stage, double seconds) {
  parts_->stages.Add({{"stage", std::string(stage)}}).Increment(std::max(0.0, seconds));
}

void Metrics::FoundCertificateDefects(std::uint64_t count) {
  parts_->defects.Increment(static_cast<double>(count));
}

absl::StatusOr<int> Metrics::Serve(const std::string& listen, std::function<ServerFigures()> figures) {
  const std::size_t colon = listen.rfind(':');
  const std::string host = colon == listen.npos ? "127.0.0.1" : listen.substr(0, colon);
  int port = -1;
  if (!absl::SimpleAtoi(listen.substr(colon == listen.npos ? 0 : colon + 1), &port) || port < 0 ||
      port > 65535 || host.empty()) {
    return absl::InvalidArgumentError(
        fmt::format("--metrics-listen {}; must be HOST:PORT, or a PORT of this machine only", listen));
  }
  parts_->snapshot = std::make_shared<Snapshot>(std::move(figures));
  try {
    parts_->exposer = std::make_unique<prometheus::Exposer>(fmt::format("{}:{}", host, port), 2);
  } catch (const std::exception&) {
    return absl::InvalidArgumentError(fmt::format(
        "--metrics-listen {}: cannot listen there; the port is taken, or the address is not of this machine",
        listen));
  }
  parts_->exposer->RegisterCollectable(parts_->registry);
  parts_->exposer->RegisterCollectable(parts_->snapshot);
  const std::vector<int> ports = parts_->exposer->GetListeningPorts();
  return ports.empty() ? port : ports.front();
}

void Metrics::Stop() {
  parts_->exposer.reset();
  parts_->snapshot.reset();
}

#else

struct Metrics::Parts {};
Metrics::Metrics() = default;
Metrics::~Metrics() = default;
void Metrics::CallEnded(std::string_view, const absl::Status&, std::string_view, double) {}
void Metrics::StageTook(std::string_view, double) {}
void Metrics::FoundCertificateDefects(std::uint64_t) {}
absl::StatusOr<int> Metrics::Serve(const std::string&, std::function<ServerFigures()>) {
  return absl::InvalidArgumentError("--metrics-listen: this patchmilld was built without prometheus-cpp");
}
void Metrics::Stop() {}

#endif

}  // namespace patchmill
