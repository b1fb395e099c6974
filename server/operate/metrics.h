// Figures of a server for Prometheus, at a port of their own.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace patchmill {

// What a server has at one moment.
struct ServerFigures {
  int running_jobs = 0, waiting_jobs = 0, job_places = 0;
  int running_quick_calls = 0, waiting_quick_calls = 0;
  int open_calls = 0;
  double resident_bytes = 0.0;  // of the process
  double memory_limit_bytes = 0.0;
  double granted_bytes = 0.0, granted_limit_bytes = 0.0;  // to jobs
  double store_bytes = 0.0, store_limit_bytes = 0.0;
  double store_values = 0.0, store_hits = 0.0, store_misses = 0.0, store_forgotten = 0.0;
  bool draining = false;
  double certificate_until = 0.0;  // seconds since 1970; 0: no TLS
};

// Any thread may call it. Without prometheus-cpp nothing is counted, and Serve fails.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  // A call has ended. `reason` is that of its ErrorInfo; empty for OK.
  void CallEnded(std::string_view method, const absl::Status& status, std::string_view reason,
                 double seconds);
  void StageTook(std::string_view stage, double seconds);
  void FoundCertificateDefects(std::uint64_t count);

  // Answers GET /metrics at `listen` until Stop: HOST:PORT, or a PORT of 127.0.0.1. Returns the port.
  // `figures` is called from another thread. INVALID_ARGUMENT for a wrong address, or one that is taken.
  absl::StatusOr<int> Serve(const std::string& listen, std::function<ServerFigures()> figures);
  void Stop();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace patchmill
