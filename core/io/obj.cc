#include "core/io/obj.h"

#include <charconv>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/text_scanner.h"

namespace patchmill {
namespace {

constexpr std::string_view kSpace = " \t\r\f\v";

std::vector<std::string_view> WordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  while (words.size() < 8) {
    const std::size_t begin = line.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return words;
    line = line.substr(begin);
    const std::size_t end = line.find_first_of(kSpace);
    words.push_back(line.substr(0, end));
    if (end == std::string_view::npos) return words;
    line = line.substr(end);
  }
  return words;
}

absl::Status ObjFault(int line, std::string_view reason) {
  return absl::InvalidArgumentError(fmt::format("line {}: {}", line, reason));
}

absl::StatusOr<int> CornerOf(std::string_view word, std::size_t points, int line) {
  const std::string_view digits = word.substr(0, word.find('/'));
  long long index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    return ObjFault(line, fmt::format("{} is no corner of a face", Quoted(word)));
  }
  const long long count = static_cast<long long>(points);
  const long long at = index < 0 ? count + index : index - 1;
  if (index == 0 || at < 0 || at >= count) {
    return ObjFault(line, fmt::format("corner {} does not exist; {} points were read so far", index, count));
  }
  return static_cast<int>(at);
}

}  // namespace

absl::StatusOr<ObjMesh> ReadObj(std::string_view text) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  ObjMesh mesh;
  int line = 0;
  while (!text.empty()) {
    ++line;
    const std::size_t end = text.find('\n');
    std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    row = row.substr(0, row.find('#'));
    const std::vector<std::string_view> words = WordsOf(row);
    if (words.empty() || (words[0] != "v" && words[0] != "f")) continue;
    if (words[0] == "v") {
      if (words.size() < 4) return ObjFault(line, "a point needs three numbers");
      if (mesh.points.size() == static_cast<std::size_t>(kMaxObjPoints)) {
        return ObjFault(line, fmt::format("more than {} points", kMaxObjPoints));
      }
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        const absl::StatusOr<double> value =
            ParseNumber(words[static_cast<std::size_t>(k) + 1], "a coordinate");
        if (!value.ok()) return ObjFault(line, std::string(value.status().message()));
        p[k] = *value;
      }
      mesh.points.push_back(p);
      continue;
    }
    if (words.size() != 4 && words.size() != 5) {
      return ObjFault(line,
                      fmt::format("a face has {} corners; must have three or four",
                                  words.size() > 7 ? "more than six" : std::to_string(words.size() - 1)));
    }
    if (mesh.faces.size() == static_cast<std::size_t>(kMaxObjFaces)) {
      return ObjFault(line, fmt::format("more than {} faces", kMaxObjFaces));
    }
    std::vector<int> face;
    for (std::size_t k = 1; k < words.size(); ++k) {
      PM_ASSIGN_OR_RETURN(const int corner, CornerOf(words[k], mesh.points.size(), line));
      face.push_back(corner);
    }
    mesh.faces.push_back(std::move(face));
  }
  if (mesh.faces.empty()) return ObjFault(std::max(line, 1), "the text holds no face");
  return mesh;
}

}  // namespace patchmill
