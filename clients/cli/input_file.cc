#include "clients/cli/input_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace patchmill::cli {
namespace {

std::vector<std::string>& Read() {
  static std::vector<std::string> paths;
  return paths;
}

std::vector<NamedInput>& Named() {
  static std::vector<NamedInput> inputs;
  return inputs;
}

}  // namespace

void NameModel(const std::string& path) {
  for (const char* field :
       {"model file", "job.source.file.content", "source.file.content", "source.file.format"})
    Named().push_back({field, path});
}
void NameProgram(const std::string& path) { Named().push_back({"program", path}); }
const std::vector<NamedInput>& NamedInputs() { return Named(); }

const std::vector<std::string>& FilesRead() { return Read(); }

absl::StatusOr<std::string> ReadWholeFile(const std::string& name, std::size_t limit) {
  const std::string path = name == "-" ? "/dev/stdin" : name;
  Read().push_back(path);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return absl::InvalidArgumentError(fmt::format("{} is a directory", path));
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return absl::InvalidArgumentError(fmt::format("cannot read {}: {}", path, std::strerror(errno)));
  std::string bytes, block(std::size_t{1} << 20, '\0');
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    bytes.append(block, 0, static_cast<std::size_t>(in.gcount()));
    if (bytes.size() > limit) {
      return absl::InvalidArgumentError(
          fmt::format("{} has more than {} MiB, the limit of such a file", path, limit >> 20));
    }
  }
  if (in.bad()) return absl::InvalidArgumentError(fmt::format("cannot read {}", path));
  return bytes;
}

}  // namespace patchmill::cli
