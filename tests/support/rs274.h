// Runs programs in LinuxCNC's own interpreter (rs274; scripts/setup.sh installs it).
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace patchmill::testing {

inline bool HasRs274() { return std::system("command -v rs274 > /dev/null") == 0; }

// What the interpreter reads beside the program.
struct Rs274Machine {
  std::string tool_table;
  std::string variables;
};

struct Rs274Answer {
  int status = -1;    // as `wait` states it; 0 when the interpreter accepted the program
  std::string calls;  // the calls of the machine, one per line, with the interpreter's own messages
};

// The interpreter keeps its tools in a file of the home folder. Every run has a home of its own, because
// runs side by side would read each other's tools.
inline Rs274Answer RunRs274(const std::string& program, const Rs274Machine& machine) {
  namespace fs = std::filesystem;
  Rs274Answer answer;
  std::string folder = (fs::temp_directory_path() / "rs274_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) return answer;
  std::ofstream(folder + "/in.ngc") << program;
  std::ofstream(folder + "/tool.tbl") << machine.tool_table;
  std::ofstream(folder + "/rs274.var") << machine.variables;
  const std::string run = "HOME=\"$PWD\" rs274 -g -t tool.tbl -v rs274.var in.ngc > calls 2>&1";
  answer.status = std::system(("cd " + folder + " && " + run).c_str());
  std::ostringstream calls;
  calls << std::ifstream(folder + "/calls").rdbuf();
  answer.calls = calls.str();
  fs::remove_all(folder);
  return answer;
}

}  // namespace patchmill::testing
