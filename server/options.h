// Options of a server. The command line includes this file, too, so it has no types of the domain.
#pragma once

#include <string>

namespace patchmill {

struct ServerOptions {
  std::string listen = "127.0.0.1:50051";  // HOST:PORT; the default is loopback; port 0: any free port
  int threads = 0;                         // of one job; 0: as many as the machine has
  int max_jobs = 0;                        // at once; 0: as many as the machine has cores
  int max_queue = 64;                      // jobs that wait; further ones are RESOURCE_EXHAUSTED
  int memory_limit_mib = 0;                // of the process; 0: DefaultMemoryLimit (memory_limit.h)
  int max_in_flight_mib = 256;      // of requests and answers at once; further ones are RESOURCE_EXHAUSTED
  int store_mib = 256;              // of models, CAD files and answers that are kept between calls
  double max_job_seconds = 3600.0;  // a longer job is DEADLINE_EXCEEDED
  double max_write_seconds = 60.0;  // a client that takes longer to read one message of an answer is cut off
  double max_idle_seconds = 60.0;   // a connection without a call for longer is closed
  double drain_seconds = 8.0;       // that running calls have after SIGTERM
  double orphan_seconds = 0.0;      // that a job goes on after its client is lost
  std::string cache_dir;            // folder of answers on disk; empty: none are written
  int cache_mib = 1024;             // most MiB of its files
  double cache_days = 7.0;          // an answer is used for so long
  // PEM files. cert and key switch TLS on. With ca, clients must have a certificate of that authority.
  std::string ca_file, cert_file, key_file;
  std::string tokens_file;              // who may call (callers_file.h); empty: anybody
  bool insecure = false;                // listens beyond loopback without TLS
  std::string metrics_listen;           // HOST:PORT, or PORT of loopback, for Prometheus; empty: nowhere
  std::string log_format = "text";      // or "json"
  bool log_requests = true;             // one line per call on stderr
  bool lower_priority_of_jobs = false;  // calls of milliseconds come first (lower_priority.h)
  double estimate_factor = 1.0;         // for tests: times the estimated memory of jobs
};

}  // namespace patchmill
