// A server process on a free port, and what the system says of it.
#pragma once

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/service/process.h"

namespace patchmill::testing {

class Daemon {
 public:
  // `shell`: what a shell does before it becomes the server ("ulimit -n 256").
  explicit Daemon(const std::string& program, const std::vector<std::string>& flags = {},
                  const std::string& shell = {})
      : process_(Command(program, flags, shell)) {
    for (int i = 0; i < 400 && port_.empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(25));
      std::smatch match;
      const std::string log = process_.Err();
      if (std::regex_search(log, match, std::regex("port ([0-9]+)\n"))) port_ = match[1];
    }
    EXPECT_FALSE(port_.empty()) << process_.Err();
  }

  std::string target() const { return "127.0.0.1:" + port_; }
  Process& process() { return process_; }
  bool Alive() const {
    return std::filesystem::exists("/proc/" + std::to_string(process_.pid()) + "/stat") && State() != 'Z';
  }
  // The most memory it has had, MiB.
  double PeakMib() const {
    std::ifstream status(Proc("status"));
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmHWM:")) return std::atof(line.c_str() + 6) / 1024.0;
    }
    return 0.0;
  }
  double CpuSeconds() const {
    std::istringstream rest = StatAfterName();
    std::string word;
    double ticks = 0.0;
    for (int field = 3; field <= 15 && rest >> word; ++field) {
      if (field >= 14) ticks += std::atof(word.c_str());
    }
    return ticks / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

 private:
  static std::vector<std::string> Command(const std::string& program, const std::vector<std::string>& flags,
                                          const std::string& shell) {
    std::vector<std::string> command = {program};
    if (flags.empty() || flags.front() != "--listen")
      command.insert(command.end(), {"--listen", "127.0.0.1:0"});
    command.insert(command.end(), flags.begin(), flags.end());
    if (shell.empty()) return command;
    std::vector<std::string> wrapped = {"/bin/bash", "-c", shell + " && exec \"$@\"", "bash"};
    wrapped.insert(wrapped.end(), command.begin(), command.end());
    return wrapped;
  }
  std::string Proc(const std::string& file) const {
    return "/proc/" + std::to_string(process_.pid()) + "/" + file;
  }
  std::istringstream StatAfterName() const {
    const std::string stat = Slurp(Proc("stat"));
    return std::istringstream(stat.substr(std::min(stat.size(), stat.rfind(')') + 1)));
  }
  char State() const {
    char state = ' ';
    StatAfterName() >> state;
    return state;
  }

  Process process_;
  std::string port_;
};

}  // namespace patchmill::testing
