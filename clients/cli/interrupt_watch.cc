#include "clients/cli/interrupt_watch.h"

#include <cerrno>
#include <ctime>
#include <string_view>

#include <grpcpp/client_context.h>
#include <unistd.h>

#include "clients/cli/temporary_files.h"

namespace patchmill::cli {
namespace {

bool IsIgnored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

[[noreturn]] void EndProcess() {
  RemoveAllTemporaryFiles();
  constexpr std::string_view kMessage = "patchmill: interrupted\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  _exit(1);
}

}  // namespace

InterruptWatch::InterruptWatch() {
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (!IsIgnored(signal)) sigaddset(&signals_, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  thread_ = std::thread([this] { Watch(); });
}

InterruptWatch::~InterruptWatch() {
  stop_.store(true);
  thread_.join();
}

void InterruptWatch::Watch() {
  const timespec tick{0, 50'000'000};
  while (!stop_.load()) {
    if (sigtimedwait(&signals_, nullptr, &tick) >= 0) Interrupt();
  }
}

void InterruptWatch::Interrupt() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (context_ == nullptr || interrupted()) EndProcess();
  interrupted_.store(true);
  context_->TryCancel();
}

void InterruptWatch::Attach(grpc::ClientContext* context) {
  const std::lock_guard<std::mutex> lock(mutex_);
  context_ = context;
  if (context_ != nullptr && interrupted()) context_->TryCancel();
}

}  // namespace patchmill::cli
