// A program run by a test: arguments in, exit status and both outputs out.
#pragma once

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace patchmill::testing {

// A directory of its own, removed at the end.
class TempDir {
 public:
  TempDir() {
    std::string name = (std::filesystem::temp_directory_path() / "patchmill.XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TempDir() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return *this / name;
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename());
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline std::string Slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Process {
 public:
  explicit Process(const std::vector<std::string>& command) {
    pid_ = fork();
    if (pid_ == 0) {
      Redirect(out_, STDOUT_FILENO);
      Redirect(err_, STDERR_FILENO);
      std::vector<char*> argv;
      for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(127);
    }
  }
  ~Process() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      Wait();
    }
  }

  pid_t pid() const { return pid_; }
  void Signal(int number) const { kill(pid_, number); }
  // Exit status; -1 when a signal ended it.
  int Wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string Out() const { return Slurp(out_); }
  std::string Err() const { return Slurp(err_); }

 private:
  static void Redirect(const std::string& path, int to) {
    dup2(open(path.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0600), to);
  }

  TempDir dir_;
  std::string out_ = dir_ / "out", err_ = dir_ / "err";
  pid_t pid_ = -1;
};

struct Finished {
  int status = -1;
  std::string out, err;
};

inline Finished Run(const std::vector<std::string>& command) {
  Process process(command);
  Finished finished;
  finished.status = process.Wait();
  finished.out = process.Out();
  finished.err = process.Err();
  return finished;
}

}  // namespace patchmill::testing
