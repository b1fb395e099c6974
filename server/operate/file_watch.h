// Notices that files have changed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace patchmill {

// Looks at files in its own thread. A file counts as changed when another one stands at its path (also where
// the path is a link), or when it was written.
class FileWatch {
 public:
  // `changed` is called from the thread, after a look that found a change of any of the files.
  FileWatch(std::vector<std::string> paths, std::function<void()> changed,
            std::chrono::milliseconds interval);
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

  // Calls `changed` soon, whether or not a file has changed.
  void Poke();

 private:
  std::string Look() const;
  void Run();

  const std::vector<std::string> paths_;
  const std::function<void()> changed_;
  const std::chrono::milliseconds interval_;
  std::string seen_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool poked_ = false, stop_ = false;
  std::thread thread_;
};

}  // namespace patchmill
