// The picture of what a program leaves, and its file.
#include "cam/picture/leftover_picture.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

LeftoverCell Square(double x, double y, std::optional<double> leftover, double z = 0.0) {
  LeftoverCell cell;
  cell.corners = {Vec3(x, y, z), Vec3(x + 1, y, z), Vec3(x + 1, y + 1, z), Vec3(x, y + 1, z)};
  cell.leftover = leftover;
  return cell;
}

std::array<int, 3> At(const PalettePicture& picture, int x, int y) {
  const auto& color = picture.palette[picture.pixels[static_cast<std::size_t>(y * picture.width + x)]];
  return {color[0], color[1], color[2]};
}

TEST(LeftoverPicture, ColoursLieWhereThePartIs) {
  // Two by two squares, y up: the upper row is not reached at the left and far above the limit at the right.
  const PalettePicture picture = DrawLeftover(
      {Square(0, 0, -0.01), Square(1, 0, 0.0), Square(0, 1, std::nullopt), Square(1, 1, 0.5)}, 0.1);
  EXPECT_EQ(picture.width, 900);
  EXPECT_EQ(picture.height, 900);
  EXPECT_EQ(At(picture, 225, 675), (std::array<int, 3>{40, 90, 200}));
  EXPECT_EQ(At(picture, 675, 675), (std::array<int, 3>{60, 160, 60}));
  EXPECT_EQ(At(picture, 225, 225), (std::array<int, 3>{170, 170, 170}));
  EXPECT_EQ(At(picture, 675, 225), (std::array<int, 3>{110, 0, 0}));
}

TEST(LeftoverPicture, TheLargestLeftoverOfADotIsShown) {
  for (const bool swapped : {false, true}) {
    std::vector<LeftoverCell> cells = {Square(0, 0, 0.0, 5.0), Square(0, 0, 0.15, 0.0)};
    if (swapped) std::swap(cells[0], cells[1]);
    EXPECT_EQ(At(DrawLeftover(cells, 0.1), 450, 450), (std::array<int, 3>{220, 40, 30}));
  }
  // Beside the part it is white, and a part without extent in y is a line.
  LeftoverCell wall = Square(0, 0, 0.0);
  wall.corners = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 0, 3), Vec3(0, 0, 3)};
  const PalettePicture line = DrawLeftover({wall}, 0.1);
  EXPECT_EQ(At(line, 0, 0), (std::array<int, 3>{60, 160, 60}));
  EXPECT_LE(line.height, 2);
  EXPECT_EQ(DrawLeftover({}, 0.1).pixels.size(), 1u);
}

// Another program reads the file.
TEST(LeftoverPicture, ThePngIsReadByOthers) {
  PalettePicture picture;
  picture.width = 300;
  picture.height = 301;  // more than one stored block
  picture.palette = {{255, 255, 255}, {1, 2, 3}};
  picture.pixels.assign(300 * 301, 0);
  picture.pixels[0] = 1;
  const std::string bytes = WritePng(picture);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_LT(bytes.size(), 300u * 301u + 500u);
  if (std::system("python3 -c 'import zlib' 2> /dev/null") != 0)
    GTEST_SKIP() << "no Python is there to read it";
  const std::string path = ::testing::TempDir() + "patchmill_leftover.png";
  std::ofstream(path, std::ios::binary) << bytes;
  const std::string script =
      "python3 - " + path +
      " <<'END'\n"
      "import struct, sys, zlib\n"
      "b = open(sys.argv[1], 'rb').read()\n"
      "at, data = 8, b''\n"
      "while at < len(b):\n"
      "    size, kind = struct.unpack('>I4s', b[at:at + 8])\n"
      "    body = b[at + 8:at + 8 + size]\n"
      "    assert struct.unpack('>I', b[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body), kind\n"
      "    if kind == b'IDAT': data += body\n"
      "    at += 12 + size\n"
      "rows = zlib.decompress(data)\n"
      "assert len(rows) == 301 * 301 and rows[1] == 1 and rows[2] == 0\n"
      "END\n";
  EXPECT_EQ(std::system(script.c_str()), 0);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace patchmill
