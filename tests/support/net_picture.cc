#include "tests/support/net_picture.h"

#include <optional>
#include <regex>
#include <sstream>

#include <gtest/gtest.h>

namespace patchmill::testing {
namespace {

struct Token {
  std::size_t begin = 0, end = 0;  // columns
  NetPlace place;
};

// The comment lines right above `struct kind {`, without the slashes.
std::vector<std::string> CommentAbove(const std::string& header, const std::string& kind) {
  std::vector<std::string> comment;
  std::istringstream in(header);
  for (std::string line; std::getline(in, line);) {
    if (line == "struct " + kind + " {") return comment;
    if (line.starts_with("//")) {
      comment.push_back(line.substr(2));
    } else {
      comment.clear();
    }
  }
  ADD_FAILURE() << "no struct " << kind;
  return {};
}

std::vector<Token> TokensOf(const std::string& line) {
  static const std::regex kNumbers("(\\d+)(,(\\d+))?");
  std::vector<Token> tokens;
  for (std::sregex_iterator it(line.begin(), line.end(), kNumbers), none; it != none; ++it) {
    const std::smatch& match = *it;
    Token token;
    token.begin = static_cast<std::size_t>(match.position());
    token.end = token.begin + static_cast<std::size_t>(match.length());
    token.place.vertical = std::stoi(match[1]);
    token.place.horizontal = match[3].matched ? std::stoi(match[3]) : token.place.vertical;
    tokens.push_back(token);
  }
  return tokens;
}

const Token* TokenAt(const std::vector<Token>& tokens, std::size_t column) {
  for (const Token& token : tokens) {
    if (token.begin <= column && column < token.end) return &token;
  }
  return nullptr;
}

// The lines of the picture alone, from the highest to the lowest, cut to its width; nothing after a fault.
std::optional<std::vector<std::string>> CutOut(const std::vector<std::string>& comment, bool& is_triangle) {
  for (std::size_t foot = 1; foot < comment.size(); ++foot) {
    const bool triangle = comment[foot].find("s=0") != std::string::npos;
    const std::string low = triangle ? "t=0" : "v=0", high = triangle ? "t=1" : "v=1";
    const std::size_t left = comment[foot].find(triangle ? "s=0" : "u=0");
    const std::size_t right = comment[foot].find(triangle ? "s=1" : "u=1");
    if (left == std::string::npos || right == std::string::npos) continue;
    if (comment[foot].find_first_not_of(' ') != left) continue;
    const std::size_t label = comment[foot - 1].find(low);
    if (label == std::string::npos || label + low.size() > left) return std::nullopt;
    std::size_t top = foot - 1;
    while (top > 0 && comment[top].find(high) != label) --top;
    if (comment[top].find(high) != label) return std::nullopt;
    std::vector<std::string> lines;
    for (std::size_t k = top; k < foot; ++k) {
      std::string line = comment[k].substr(0, right + high.size() + 1);
      for (std::size_t c = 0; c < label + high.size() && c < line.size(); ++c) line[c] = ' ';
      lines.push_back(line);
    }
    is_triangle = triangle;
    return lines;
  }
  return std::nullopt;
}

// Lines up and down between places of rows[row] and of the next higher row with a place in that column.
void FindVerticalLines(const std::vector<std::string>& lines, const std::vector<std::vector<Token>>& tokens,
                       NetPicture& picture) {
  for (std::size_t k = lines.size(); k-- > 0;) {
    for (const Token& token : tokens[k]) {
      for (std::size_t c = token.begin; c < token.end; ++c) {
        std::size_t above = k;
        while (above > 0 && c < lines[above - 1].size() && lines[above - 1][c] == '|') --above;
        if (above == k || above == 0) continue;
        if (const Token* upper = TokenAt(tokens[above - 1], c)) {
          picture.lines.push_back({token.place.vertical, upper->place.vertical, true});
        }
      }
    }
  }
}

void FindHorizontalLines(const std::string& line, const std::vector<Token>& tokens, NetPicture& picture) {
  for (std::size_t k = 1; k < tokens.size(); ++k) {
    const std::string between = line.substr(tokens[k - 1].end, tokens[k].begin - tokens[k - 1].end);
    if (between.find('-') == std::string::npos || between.find_first_not_of(" -") != std::string::npos) {
      continue;
    }
    picture.lines.push_back({tokens[k - 1].place.horizontal, tokens[k].place.horizontal, false});
  }
}

}  // namespace

NetPicture ReadNetPicture(const std::string& header, const std::string& kind) {
  NetPicture picture;
  const auto lines = CutOut(CommentAbove(header, kind), picture.is_triangle);
  if (!lines) {
    ADD_FAILURE() << "no picture with the labels of its four sides above struct " << kind;
    return picture;
  }
  std::vector<std::vector<Token>> tokens;
  std::vector<int> left, right;
  for (const std::string& line : *lines) {
    tokens.push_back(TokensOf(line));
    const std::vector<Token>& found = tokens.back();
    FindHorizontalLines(line, found, picture);
    if (found.empty()) continue;
    std::vector<NetPlace> row;
    for (const Token& token : found) row.push_back(token.place);
    picture.rows.insert(picture.rows.begin(), row);
    // On the frame: nothing drawn beyond it.
    if (line.find_first_not_of(' ') == found.front().begin) left.insert(left.begin(), row.front().horizontal);
    if (line.find_last_not_of(' ') + 1 == found.back().end)
      right.insert(right.begin(), row.back().horizontal);
  }
  FindVerticalLines(*lines, tokens, picture);
  std::vector<int> low, high;
  for (const NetPlace& place : picture.rows.front()) low.push_back(place.vertical);
  for (const NetPlace& place : picture.rows.back()) high.push_back(place.vertical);
  picture.sides = picture.is_triangle ? std::vector{low, right, left} : std::vector{low, right, high, left};
  return picture;
}

}  // namespace patchmill::testing
