#include "core/io/bez.h"

#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/io/model_builder.h"
#include "core/io/text_scanner.h"

namespace patchmill {
namespace {

constexpr char kComment = '#';
constexpr int kMaxBezDegree = 6;

struct Header {
  int degree_u = 3, degree_v = 3;
  bool rational = false;
};

absl::StatusOr<Header> ReadHeader(TextScanner& scanner) {
  PM_ASSIGN_OR_RETURN(const std::string_view key, scanner.Word("\"BBP\" or \"BEZ\""));
  if (key == "BBP") return Header();
  const auto digit = [&](std::size_t k) { return key[k] - '0'; };
  const bool degrees = key.size() == 6 && key.substr(0, 3) == "BEZ" && digit(3) >= 1 &&
                       digit(3) <= kMaxBezDegree && digit(4) >= 1 && digit(4) <= kMaxBezDegree;
  if (degrees && (digit(5) == 3 || digit(5) == 4)) return Header{digit(3), digit(4), digit(5) == 4};
  constexpr std::string_view kKnown =
      "known are BBP and BEZabc with degrees a and b from 1 to 6 and c = 3 or 4 numbers per point";
  if (key == "STBBP" || key.substr(0, 4) == "CBEZ" || (key.size() > 6 && key.substr(6) == "_ST")) {
    return scanner.Fail(fmt::format("{} carries texture coordinates or colours, which are not read; {}",
                                    Quoted(key), kKnown));
  }
  return scanner.Fail(fmt::format("{} is no known first word; {}", Quoted(key), kKnown));
}

absl::StatusOr<PatchShape> ReadPatch(TextScanner& scanner, const Header& header) {
  BezierPatch patch;
  patch.degree_u = header.degree_u;
  patch.degree_v = header.degree_v;
  const int nu = header.degree_u + 1, nv = header.degree_v + 1;
  if (header.rational) {
    PM_ASSIGN_OR_RETURN(RationalPoints points, ReadRationalPoints(scanner, nu * nv));
    patch.points = SecondFastest(points.points, nv, nu);
    patch.weights = SecondFastest(points.weights, nv, nu);
  } else {
    PM_ASSIGN_OR_RETURN(const std::vector<Vec3> points, ReadPoints(scanner, nu * nv));
    patch.points = SecondFastest(points, nv, nu);
  }
  return patch;
}

}  // namespace

absl::StatusOr<PatchModel> ReadBez(std::string_view text) {
  TextScanner scanner(text, kComment);
  PM_ASSIGN_OR_RETURN(const Header header, ReadHeader(scanner));
  ModelBuilder builder;
  while (!scanner.AtEnd()) {
    const int line = scanner.line();
    PM_ASSIGN_OR_RETURN(PatchShape shape, ReadPatch(scanner, header));
    PM_RETURN_IF_ERROR(builder.Add(scanner, line, std::move(shape)));
  }
  if (builder.empty()) return scanner.Fail("the text holds no patch");
  return builder.Finish(scanner);
}

}  // namespace patchmill
