#include "server/operate/file_watch.h"

#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

namespace patchmill {

FileWatch::FileWatch(std::vector<std::string> paths, std::function<void()> changed,
                     std::chrono::milliseconds interval)
    : paths_(std::move(paths)), changed_(std::move(changed)), interval_(interval), seen_(Look()) {
  thread_ = std::thread([this] { Run(); });
}

FileWatch::~FileWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void FileWatch::Poke() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    poked_ = true;
  }
  wake_.notify_all();
}

std::string FileWatch::Look() const {
  std::string all;
  for (const std::string& path : paths_) {
    struct stat file {};
    if (stat(path.c_str(), &file) != 0) {
      all += "none;";
      continue;
    }
    all += fmt::format("{} {} {} {} {};", file.st_dev, file.st_ino, file.st_size, file.st_mtim.tv_sec,
                       file.st_mtim.tv_nsec);
  }
  return all;
}

void FileWatch::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stop_) {
    wake_.wait_for(lock, interval_, [this] { return stop_ || poked_; });
    if (stop_) return;
    std::string now = Look();
    const bool poked = std::exchange(poked_, false);
    if (now == seen_ && !poked) continue;
    seen_ = std::move(now);
    lock.unlock();
    changed_();
    lock.lock();
  }
}

}  // namespace patchmill
