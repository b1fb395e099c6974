// Options of a server. The command line includes this file, too, so it has no types of the domain.
#pragma once

#include <string>

namespace patchmill {

struct ServerOptions {
  std::string listen = "127.0.0.1:50051";  // HOST:PORT; the default is loopback; port 0: any free port
  int threads = 0;                         // of one job; 0: as many as the machine has
  int max_jobs = 4;                        // at once; further ones are RESOURCE_EXHAUSTED
  int max_in_flight_mib = 256;      // of requests and answers at once; further ones are RESOURCE_EXHAUSTED
  double max_job_seconds = 3600.0;  // a longer job is DEADLINE_EXCEEDED
  double max_write_seconds = 60.0;  // a client that takes longer to read one message of an answer is cut off
  double max_idle_seconds = 60.0;   // a connection without a call for longer is closed
  // PEM files. cert and key switch TLS on. With ca, clients must have a certificate of that authority.
  std::string ca_file, cert_file, key_file;
  bool insecure = false;     // listens beyond loopback without TLS
  bool log_requests = true;  // one line per call on stderr
};

}  // namespace patchmill
