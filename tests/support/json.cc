#include "tests/support/json.h"

#include <cctype>
#include <charconv>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace patchmill::testing {
namespace {

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Json Document() {
    Json json = Value();
    Space();
    if (at_ != text_.size()) Fail("more after the end");
    return json;
  }

 private:
  [[noreturn]] void Fail(const char* what) const {
    throw std::runtime_error("JSON, byte " + std::to_string(at_) + ": " + what);
  }
  void Space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  char Peek() {
    Space();
    if (at_ == text_.size()) Fail("unexpected end");
    return text_[at_];
  }
  bool Take(char c) {
    if (Peek() != c) return false;
    ++at_;
    return true;
  }
  void Need(char c) {
    if (!Take(c)) Fail("unexpected character");
  }
  bool TakeWord(std::string_view word) {
    if (text_.substr(at_, word.size()) != word) return false;
    at_ += word.size();
    return true;
  }

  std::string Text() {
    Need('"');
    std::string out;
    for (; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] != '\\') {
        out += text_[at_];
        continue;
      }
      if (++at_ == text_.size()) break;
      switch (text_[at_]) {
        case 'n':
          out += '\n';
          break;
        case 't':
          out += '\t';
          break;
        case 'r':
          out += '\r';
          break;
        case 'u': {  // kept to what our files hold: Latin-1
          unsigned code = 0;
          const auto [end, error] = std::from_chars(text_.data() + at_ + 1, text_.data() + at_ + 5, code, 16);
          if (error != std::errc() || end != text_.data() + at_ + 5 || code > 255) Fail("bad \\u");
          out += static_cast<char>(code);
          at_ += 4;
          break;
        }
        default:
          out += text_[at_];
      }
    }
    Need('"');
    return out;
  }

  Json Value() {
    const char c = Peek();
    if (c == '"') return {Text()};
    if (c == '[') {
      ++at_;
      Json::Array items;
      if (Take(']')) return {items};
      do items.push_back(Value());
      while (Take(','));
      Need(']');
      return {std::move(items)};
    }
    if (c == '{') {
      ++at_;
      Json::Object members;
      if (Take('}')) return {members};
      do {
        Space();
        std::string key = Text();
        Need(':');
        members[std::move(key)] = Value();
      } while (Take(','));
      Need('}');
      return {std::move(members)};
    }
    if (TakeWord("true")) return {true};
    if (TakeWord("false")) return {false};
    if (TakeWord("null")) return {nullptr};
    double number = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
    if (error != std::errc()) Fail("no value");
    at_ = static_cast<std::size_t>(end - text_.data());
    return {number};
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Json ParseJson(std::string_view text) { return Parser(text).Document(); }

Json LoadJson(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot open " + path);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return ParseJson(text);
}

}  // namespace patchmill::testing
