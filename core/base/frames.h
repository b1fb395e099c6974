// The importer answers the process that started it with frames on a pipe. A frame is a kind, a length and as
// many bytes. The last frame is a result or an error.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace patchmill {

enum class FrameKind : std::uint8_t {
  kProgress = 1,  // text: a fraction in [0,1], a space and the name of the stage
  kResult = 2,    // bytes of a v1.ImportResult
  kError = 3,     // text: a code in UPPER_SNAKE_CASE, a space and a sentence
};

// The five bytes before the content: the kind, then the length, lowest byte first.
inline std::string FrameHead(FrameKind kind, std::uint32_t length) {
  std::string head(1, static_cast<char>(kind));
  for (int k = 0; k < 4; ++k) head.push_back(static_cast<char>(length >> (8 * k) & 0xFFU));
  return head;
}

struct Frame {
  FrameKind kind = FrameKind::kError;
  std::string_view content;
};
inline constexpr std::size_t kFrameHeadBytes = 5;

// The first frame in `bytes`, which then begin behind it. False as long as it is not complete.
inline bool TakeFrame(std::string_view& bytes, Frame& frame) {
  if (bytes.size() < kFrameHeadBytes) return false;
  std::size_t length = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    length |= static_cast<std::size_t>(static_cast<unsigned char>(bytes[1 + k])) << (8 * k);
  }
  if (bytes.size() - kFrameHeadBytes < length) return false;
  frame = {static_cast<FrameKind>(bytes[0]), bytes.substr(kFrameHeadBytes, length)};
  bytes.remove_prefix(kFrameHeadBytes + length);
  return true;
}

}  // namespace patchmill
