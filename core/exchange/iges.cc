#include "core/exchange/iges.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/exchange/number_text.h"

namespace patchmill {
namespace {

constexpr std::size_t kDataColumns = 64, kLineColumns = 72;

std::string Hollerith(const std::string& text) { return fmt::format("{}H{}", text.size(), text); }

// Fields of a free-format section, broken into lines at their ends.
class FieldLines {
 public:
  explicit FieldLines(std::size_t columns) : columns_(columns) {}
  void Add(const std::string& field, char end = ',') {
    if (line_.size() + field.size() + 1 > columns_) Break();
    line_ += field;
    line_ += end;
  }
  std::vector<std::string> Take() {
    if (!line_.empty()) Break();
    return std::move(lines_);
  }

 private:
  void Break() {
    lines_.push_back(std::move(line_));
    line_.clear();
  }
  std::size_t columns_;
  std::string line_;
  std::vector<std::string> lines_;
};

std::vector<std::string> ParametersOf(const BsplinePatch& patch) {
  FieldLines lines(kDataColumns);
  const int nv = static_cast<int>(patch.knots_v.size()) - patch.degree_v - 1;
  const int nu = static_cast<int>(patch.knots_u.size()) - patch.degree_u - 1;
  const bool rational = !patch.weights.empty();
  for (const int k : {128, nu - 1, nv - 1, patch.degree_u, patch.degree_v, 0, 0, rational ? 0 : 1, 0, 0})
    lines.Add(fmt::format("{}", k));
  for (const double t : patch.knots_u) lines.Add(RealText(t));
  for (const double t : patch.knots_v) lines.Add(RealText(t));
  // The first parameter runs fastest.
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) lines.Add(rational ? RealText(patch.weights[At(i * nv + j)]) : "1.");
  }
  for (int j = 0; j < nv; ++j) {
    for (int i = 0; i < nu; ++i) {
      for (int c = 0; c < 3; ++c) lines.Add(RealText(patch.points[At(i * nv + j)][c]));
    }
  }
  lines.Add(RealText(patch.knots_u.front()));
  lines.Add(RealText(patch.knots_u.back()));
  lines.Add(RealText(patch.knots_v.front()));
  lines.Add(RealText(patch.knots_v.back()), ';');
  return lines.Take();
}

std::vector<std::string> GlobalLines(double largest) {
  FieldLines lines(kLineColumns);
  const std::string fixed_date = "15H20000101.000000";
  for (const std::string& field : {Hollerith(","),        Hollerith(";"),         Hollerith("patchmill"),
                                   Hollerith("part.igs"), Hollerith("Patchmill"), Hollerith("Patchmill"),
                                   std::string("32"),     std::string("38"),      std::string("6"),
                                   std::string("308"),    std::string("15"),      Hollerith("patchmill"),
                                   std::string("1."),     std::string("2"),       Hollerith("MM"),
                                   std::string("1"),      std::string("0.01"),    fixed_date,
                                   std::string("1.E-7"),  RealText(largest),      Hollerith(""),
                                   Hollerith(""),         std::string("11"),      std::string("0")}) {
    lines.Add(field == "0H" ? std::string() : field);
  }
  lines.Add(fixed_date, ';');
  return lines.Take();
}

}  // namespace

std::string IgesText(const SplineSurfaces& surfaces) {
  std::string text, parameters;
  fmt::format_to(std::back_inserter(text), "{:<72}S{:7}\n", "Surfaces of a Patchmill model, in millimetres.",
                 1);
  double largest = 0.0;
  for (const SplineSurface& s : surfaces.surfaces) {
    for (const Vec3& p : s.surface.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  }
  const std::vector<std::string> globals = GlobalLines(largest);
  for (std::size_t k = 0; k < globals.size(); ++k)
    fmt::format_to(std::back_inserter(text), "{:<72}G{:7}\n", globals[k], k + 1);
  std::size_t directory = 1, line = 1;
  for (const SplineSurface& s : surfaces.surfaces) {
    const std::vector<std::string> data = ParametersOf(s.surface);
    fmt::format_to(std::back_inserter(text), "{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:>8}D{:7}\n", 128, line, 0, 1,
                   0, 0, 0, 0, "00000000", directory);
    std::string label = s.name.substr(0, 8);
    fmt::format_to(std::back_inserter(text), "{:8}{:8}{:8}{:8}{:8}{:8}{:8}{:>8}{:8}D{:7}\n", 128, 0, 0,
                   data.size(), 0, "", "", label, 0, directory + 1);
    for (const std::string& part : data)
      fmt::format_to(std::back_inserter(parameters), "{:<64} {:7}P{:7}\n", part, directory, line++);
    directory += 2;
  }
  text += parameters;
  const std::string counts = fmt::format("S{:7}G{:7}D{:7}P{:7}", 1, globals.size(), directory - 1, line - 1);
  fmt::format_to(std::back_inserter(text), "{:<72}T{:7}\n", counts, 1);
  return text;
}

}  // namespace patchmill
