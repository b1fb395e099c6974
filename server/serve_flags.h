// The options of a server, for `patchmilld` and `patchmill serve` alike.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "server/operate/serve_words.h"
#include "server/options.h"

namespace patchmill {

inline constexpr char kServeFooter[] =
    "Each option may also stand in the environment (--max-jobs as PATCHMILLD_MAX_JOBS) and in the file of\n"
    "--config (max-jobs = 4). The command line goes before the environment, the environment before the "
    "file.\n"
    "\n"
    "Examples:\n"
    "  patchmilld                                          this machine only, 127.0.0.1:50051\n"
    "  patchmilld --listen 0.0.0.0:50051 --cert server.pem --key server.key --tokens tokens.conf\n"
    "                                                      the network, over TLS, for callers with a token\n"
    "  patchmilld --check-health localhost:50051 --ca ca.pem\n"
    "\n"
    "Signals: SIGTERM and SIGINT drain and end the server; SIGHUP reads tokens and certificates again. They "
    "are\n"
    "also read again when they change.\n"
    "Exit status: 0 ended by a signal, or healthy; 1 not healthy; 2 the configuration is wrong.";

inline void AddServeFlags(CLI::App& app, ServerOptions& options, std::string& config) {
  const char* group = "Address and encryption";
  app.add_option(
         "--listen", options.listen,
         "HOST:PORT; 0.0.0.0 opens the service to the network and needs --cert and --key, or --insecure")
      ->capture_default_str()
      ->group(group);
  app.add_option("--cert", options.cert_file, "TLS: certificate of this server (PEM)")->group(group);
  app.add_option("--key", options.key_file, "TLS: key of that certificate (PEM)")->group(group);
  app.add_option("--ca", options.ca_file,
                 "TLS: accept only clients with a certificate of this authority (PEM)")
      ->group(group);
  app.add_flag("--insecure", options.insecure,
               "listen beyond this machine without TLS: anybody may read the traffic and call the service")
      ->group(group);
  app.add_option("--max-idle-seconds", options.max_idle_seconds,
                 "longest a connection may be without a call, s; then it is closed")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str()
      ->group(group);

  group = "Callers";
  app.add_option(
         "--tokens", options.tokens_file,
         "file of callers: their bearer tokens and quotas (docs/operations.md); without it anybody calls")
      ->group(group);

  group = "Jobs";
  app.add_option("--threads", options.threads, "number of threads of one job; 0: all")
      ->check(CLI::Range(0, 64))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-jobs", options.max_jobs,
                 "largest number of jobs at once, more wait; 0: as many as the machine has cores")
      ->check(CLI::Range(0, 64))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-queue", options.max_queue, "largest number of jobs that wait; more are refused")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-job-seconds", options.max_job_seconds, "longest time of a job, s")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-write-seconds", options.max_write_seconds,
                 "longest a client may take to read a message of an answer, s; then it is cut off")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--orphan-seconds", options.orphan_seconds,
         "how long a job goes on after its client is lost, s: the same request joins it, or gets its answer")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str()
      ->group(group);
  app.add_option("--drain-seconds", options.drain_seconds,
                 "how long running calls may go on after SIGTERM or SIGINT, s")
      ->check(CLI::Range(0.0, 86400.0))
      ->capture_default_str()
      ->group(group);

  group = "Memory and store";
  app.add_option("--memory-limit", options.memory_limit_mib,
                 "most MiB that the process takes; 0: the limit of its control group, else three quarters of "
                 "the machine's memory")
      ->check(CLI::Range(0, 1 << 22))
      ->capture_default_str()
      ->group(group);
  app.add_option("--max-in-flight-mib", options.max_in_flight_mib,
                 "most MiB of requests and answers at once, on their way and in memory; more are refused")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str()
      ->group(group);
  app.add_option("--store-mib", options.store_mib,
                 "most MiB of uploaded models, CAD files and answers that are kept between calls; 0: none")
      ->check(CLI::Range(0, 1 << 20))
      ->capture_default_str()
      ->group(group);
  app.add_option(
         "--cache-dir", options.cache_dir,
         "folder where answers of jobs are kept for the time after a restart; only its owner can read them")
      ->group(group);
  app.add_option("--cache-mib", options.cache_mib, "most MiB of the files in --cache-dir")
      ->check(CLI::Range(1, 1 << 22))
      ->capture_default_str()
      ->group(group);
  app.add_option("--cache-days", options.cache_days, "for how many days an answer in --cache-dir is used")
      ->check(CLI::Range(0.0, 3650.0))
      ->capture_default_str()
      ->group(group);

  group = "Log and metrics";
  app.add_option(
         "--log-format", options.log_format,
         "form of the lines on stderr, two for each call: text or json; no word of a model is in them")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str()
      ->group(group);
  app.add_option("--metrics-listen", options.metrics_listen,
                 "HOST:PORT, or PORT of this machine only, where Prometheus reads /metrics; default: nowhere")
      ->group(group);

  app.add_option("--config", config, "file with these options: lines \"max-jobs = 4\", \"insecure = true\"")
      ->group("Configuration");
  app.add_option("--estimate-factor", options.estimate_factor)->group("");  // for tests
  app.footer(kServeFooter);
}

// The arguments with the environment and the file of --config behind them. After a message on stderr: none.
inline std::optional<ServeWords> ServeArguments(const CLI::App& app, const char* program,
                                                std::vector<std::string> words) {
  std::vector<ServeOption> options;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      if (name != "help" && name != "version" && name != "check-health")
        options.push_back({name, option->get_items_expected_max() == 0});
    }
  }
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable) variables.emplace_back(*variable);
  absl::StatusOr<ServeWords> collected = CollectServeWords(std::move(words), options, variables);
  if (collected.ok()) return *std::move(collected);
  std::fprintf(stderr, "%s: %s\n", program, std::string(collected.status().message()).c_str());
  return std::nullopt;
}

// Writes the error of a wrong option, with the place that it comes from. Returns the exit status; --help and
// --version are no errors.
inline int ServeUsageError(const CLI::App& app, const char* program, const CLI::ParseError& error,
                           const ServeWords& words) {
  if (error.get_exit_code() == 0) return app.exit(error);
  const std::string text = error.what();
  std::string place;
  for (const auto& [option, origin] : words.origin) {
    if (text.starts_with(option + ":") || text.starts_with(option + " ")) place = " (from " + origin + ")";
  }
  std::fprintf(stderr, "%s: %s%s; --help lists all options\n", program, text.c_str(), place.c_str());
  return 2;
}

}  // namespace patchmill
