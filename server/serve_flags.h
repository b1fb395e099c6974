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
  app.add_option("--max-jobs", options.max_jobs,
                 "largest number of jobs at once, more wait; 0: as many as the machine has cores")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  app.add_option("--max-queue", options.max_queue, "largest number of jobs that wait; more are refused")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  app.add_option("--memory-limit", options.memory_limit_mib,
                 "most MiB that the process takes; 0: the limit of its control group, else three quarters of "
                 "the machine's memory")
      ->check(CLI::Range(0, 1 << 22))
      ->capture_default_str();
  app.add_option("--store-mib", options.store_mib,
                 "most MiB of uploaded models, CAD files and answers that are kept between calls; 0: none")
      ->check(CLI::Range(0, 1 << 20))
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
  app.add_option("--drain-seconds", options.drain_seconds,
                 "how long running calls may go on after SIGTERM or SIGINT, s")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  app.add_option(
         "--orphan-seconds", options.orphan_seconds,
         "how long a job goes on after its client is lost, s: the same request joins it, or gets its answer")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str();
  app.add_option(
      "--cache-dir", options.cache_dir,
      "folder where answers of jobs are kept for the time after a restart; only its owner can read them");
  app.add_option("--cache-mib", options.cache_mib, "most MiB of the files in --cache-dir")
      ->check(CLI::Range(1, 1 << 22))
      ->capture_default_str();
  app.add_option("--cache-days", options.cache_days, "for how many days an answer in --cache-dir is used")
      ->check(CLI::Range(0.0, 3650.0))
      ->capture_default_str();
  app.add_option("--estimate-factor", options.estimate_factor)->group("");  // for tests
  app.add_option("--cert", options.cert_file, "TLS: certificate of this server (PEM)");
  app.add_option("--key", options.key_file, "TLS: key of that certificate (PEM)");
  app.add_flag("--insecure", options.insecure,
               "listen beyond this machine without TLS: anybody may read the traffic and call the service");
  app.add_option("--ca", options.ca_file,
                 "TLS: accept only clients with a certificate of this authority (PEM)");
}

}  // namespace patchmill
