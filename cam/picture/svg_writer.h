// Writes simple SVG: shapes, with short numbers and escaped text, into a string.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

class SvgWriter {
 public:
  SvgWriter(double width, double height);
  // Points are in px, y down. `style` is written verbatim: fill="..." stroke="...".
  void Polygon(const std::vector<Vec2>& points, std::string_view style);
  void Polyline(const std::vector<Vec2>& points, std::string_view style);
  void Line(const Vec2& a, const Vec2& b, std::string_view style);
  void Rect(const Vec2& corner, double width, double height, std::string_view style);
  void Circle(const Vec2& middle, double radius, std::string_view style);
  void Text(const Vec2& at, double size, std::string_view text, std::string_view style = "");
  void OpenGroup(std::string_view style);
  void CloseGroup();
  void Raw(std::string_view text) { out_ += text; }
  std::size_t size() const { return out_.size(); }
  std::string Finish() &&;

 private:
  void Points(const std::vector<Vec2>& points);
  std::string out_;
};

std::string EscapeXml(std::string_view text);

}  // namespace patchmill
