// How a server is run. Seen by the command line too, so nothing of the domain stands here.
#pragma once

#include <string>

namespace patchmill {

struct ServerOptions {
  std::string listen = "127.0.0.1:50051";  // HOST:PORT; loopback unless told otherwise; port 0: any free one
  int threads = 0;                         // of one job; 0: as many as the machine has
  int max_jobs = 4;                        // at once; more are RESOURCE_EXHAUSTED
  int max_in_flight_mib = 256;             // of requests and answers at once; more are RESOURCE_EXHAUSTED
  double max_job_seconds = 3600.0;         // then the job is DEADLINE_EXCEEDED
  double max_write_seconds = 60.0;  // until a client has taken a message of an answer; then it is cut off
  double max_idle_seconds = 60.0;   // without a call; then a connection is closed
  // PEM; cert and key: TLS; ca too: clients must show a certificate
  std::string ca_file, cert_file, key_file;
  bool insecure = false;     // listens beyond loopback without TLS
  bool log_requests = true;  // one line per call on stderr
};

}  // namespace patchmill
