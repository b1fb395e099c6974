#include "cam/picture/svg_writer.h"

#include <iterator>

#include <fmt/format.h>

namespace patchmill {

std::string EscapeXml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return out;
}

SvgWriter::SvgWriter(double width, double height) {
  out_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\" "
      "font-family=\"Helvetica, Arial, sans-serif\">\n",
      width, height);
}

void SvgWriter::Points(const std::vector<Vec2>& points) {
  for (const Vec2& p : points) fmt::format_to(std::back_inserter(out_), "{:.2f},{:.2f} ", p.x(), p.y());
}

void SvgWriter::Polygon(const std::vector<Vec2>& points, std::string_view style) {
  out_ += "<polygon points=\"";
  Points(points);
  fmt::format_to(std::back_inserter(out_), "\" {}/>\n", style);
}

void SvgWriter::Polyline(const std::vector<Vec2>& points, std::string_view style) {
  out_ += "<polyline points=\"";
  Points(points);
  fmt::format_to(std::back_inserter(out_), "\" {}/>\n", style);
}

void SvgWriter::Line(const Vec2& a, const Vec2& b, std::string_view style) {
  fmt::format_to(std::back_inserter(out_),
                 "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n", a.x(), a.y(), b.x(),
                 b.y(), style);
}

void SvgWriter::Circle(const Vec2& middle, double radius, std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}/>\n",
                 middle.x(), middle.y(), radius, style);
}

void SvgWriter::Rect(const Vec2& corner, double width, double height, std::string_view style) {
  fmt::format_to(std::back_inserter(out_),
                 "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}/>\n", corner.x(),
                 corner.y(), width, height, style);
}

void SvgWriter::Text(const Vec2& at, double size, std::string_view text, std::string_view style) {
  fmt::format_to(std::back_inserter(out_),
                 "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.1f}\" {}>{}</text>\n", at.x(), at.y(), size,
                 style, EscapeXml(text));
}

void SvgWriter::OpenGroup(std::string_view style) {
  fmt::format_to(std::back_inserter(out_), "<g {}>\n", style);
}
void SvgWriter::CloseGroup() { out_ += "</g>\n"; }

std::string SvgWriter::Finish() && {
  out_ += "</svg>\n";
  return std::move(out_);
}

}  // namespace patchmill
