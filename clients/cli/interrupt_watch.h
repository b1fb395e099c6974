// How a command ends early.
#pragma once

#include <atomic>
#include <csignal>
#include <mutex>
#include <thread>

namespace grpc {
class ClientContext;
}

namespace patchmill::cli {

// SIGINT, SIGTERM and SIGHUP cancel the call that runs, so that the command ends with its reason. Where no
// call runs, as when a pipe has no reader, and at the second signal, the process ends at once. No temporary
// file is left in either case. The constructor blocks the signals, except those that the parent process
// ignores (nohup): make this object before any other thread.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  void Attach(grpc::ClientContext* context);  // the call to cancel; lives until Detach
  void Detach() { Attach(nullptr); }
  bool interrupted() const { return interrupted_.load(); }

 private:
  void Watch();
  void Interrupt();

  sigset_t signals_;
  std::mutex mutex_;
  grpc::ClientContext* context_ = nullptr;
  std::atomic<bool> interrupted_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace patchmill::cli
