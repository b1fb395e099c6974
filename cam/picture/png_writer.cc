#include "cam/picture/png_writer.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "core/base/status.h"

namespace patchmill {
namespace {

void AppendBigEndian(std::uint32_t value, std::string& out) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((value >> shift) & 0xffU);
}

// The checksum of chunks: CRC-32 with the polynomial 0xedb88320.
std::uint32_t Crc(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

// The checksum of zlib data.
std::uint32_t Adler(std::string_view bytes) {
  constexpr std::uint32_t kModulus = 65521;
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<std::uint8_t>(byte)) % kModulus;
    b = (b + a) % kModulus;
  }
  return (b << 16U) | a;
}

void AppendChunk(std::string_view kind, std::string_view data, std::string& out) {
  AppendBigEndian(static_cast<std::uint32_t>(data.size()), out);
  const std::size_t begin = out.size();
  out += kind;
  out += data;
  AppendBigEndian(Crc(std::string_view(out).substr(begin)), out);
}

// zlib data in stored blocks.
std::string Stored(std::string_view bytes) {
  constexpr std::size_t kMost = 65535;  // bytes of a block
  std::string out = "\x78\x01";
  for (std::size_t at = 0; at < bytes.size(); at += kMost) {
    const std::string_view block = bytes.substr(at, kMost);
    out += static_cast<char>(at + block.size() == bytes.size() ? 1 : 0);
    const auto size = static_cast<std::uint16_t>(block.size());
    for (const unsigned value : {static_cast<unsigned>(size), 0xffffU ^ size}) {
      out += static_cast<char>(value & 0xffU);
      out += static_cast<char>((value >> 8U) & 0xffU);
    }
    out += block;
  }
  AppendBigEndian(Adler(bytes), out);
  return out;
}

}  // namespace

std::string WritePng(const PalettePicture& picture) {
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  PM_CHECK(picture.width > 0 && picture.height > 0 && picture.pixels.size() == width * height);
  PM_CHECK(!picture.palette.empty() && picture.palette.size() <= 256);
  PM_CHECK(*std::max_element(picture.pixels.begin(), picture.pixels.end()) < picture.palette.size());
  std::string out("\x89PNG\r\n\x1a\n", 8);
  std::string header;
  AppendBigEndian(static_cast<std::uint32_t>(picture.width), header);
  AppendBigEndian(static_cast<std::uint32_t>(picture.height), header);
  header += std::string("\x08\x03\0\0\0", 5);  // 8 bits, palette, deflate, no filter, not interlaced
  AppendChunk("IHDR", header, out);
  std::string palette;
  for (const auto& color : picture.palette) {
    for (const std::uint8_t value : color) palette += static_cast<char>(value);
  }
  AppendChunk("PLTE", palette, out);
  std::string rows;
  rows.reserve((width + 1) * height);
  for (std::size_t row = 0; row < height; ++row) {
    rows += '\0';  // no filter
    rows.append(picture.pixels.begin() + static_cast<std::ptrdiff_t>(row * width),
                picture.pixels.begin() + static_cast<std::ptrdiff_t>((row + 1) * width));
  }
  AppendChunk("IDAT", Stored(rows), out);
  AppendChunk("IEND", "", out);
  return out;
}

}  // namespace patchmill
