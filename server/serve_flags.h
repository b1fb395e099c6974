// The options of a server, for `patchmilld` and `patchmill serve` alike.
#pragma once

#include <CLI/CLI.hpp>

#include "server/options.h"

namespace patchmill {

inline void AddServeFlags(CLI::App& app, ServerOptions& options) {
  app.add_option(
         "--listen", options.listen,
         "HOST:PORT; 0.0.0.0 opens the service to the network and needs --cert and --key, or --insecure")
      ->capture_default_str();
  app.add_option("--threads", options.threads, "number of threads of one job; 0: all")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  app.add_option("--max-jobs", options.max_jobs, "largest number of jobs at once; more are refused")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--max-in-flight-mib", options.max_in_flight_mib,
                 "most MiB of requests and answers at once, on their way and in memory; more are refused")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  app.add_option("--max-job-seconds", options.max_job_seconds, "longest time of a job, s")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  app.add_option("--max-write-seconds", options.max_write_seconds,
                 "longest a client may take to read a message of an answer, s; then it is cut off")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str();
  app.add_option("--max-idle-seconds", options.max_idle_seconds,
                 "longest a connection may be without a call, s; then it is closed")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  app.add_option("--cert", options.cert_file, "TLS: certificate of this server (PEM)");
  app.add_option("--key", options.key_file, "TLS: key of that certificate (PEM)");
  app.add_flag("--insecure", options.insecure,
               "listen beyond this machine without TLS: anybody may read the traffic and call the service");
  app.add_option("--ca", options.ca_file,
                 "TLS: accept only clients with a certificate of this authority (PEM)");
}

}  // namespace patchmill
