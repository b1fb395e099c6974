#include "proto/json/nearest_word.h"

#include <algorithm>
#include <cstddef>

namespace patchmill {
namespace {

constexpr std::size_t kLongest = 100;  // characters; longer words are nobody's slip

// Damerau's distance of two words: changes that make one of the other.
std::size_t ChangesBetween(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> changes(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        changes[i][j] = i + j;
        continue;
      }
      const bool same = a[i - 1] == b[j - 1];
      std::size_t least =
          std::min({changes[i - 1][j] + 1, changes[i][j - 1] + 1, changes[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        least = std::min(least, changes[i - 2][j - 2] + 1);
      changes[i][j] = least;
    }
  }
  return changes[a.size()][b.size()];
}

}  // namespace

std::string NearestWord(std::string_view word, const std::vector<std::string>& known) {
  if (word.size() > kLongest) return "";
  std::string nearest;
  std::size_t most = std::max<std::size_t>(1, word.size() / 3);
  for (const std::string& candidate : known) {
    if (candidate.size() > kLongest) continue;
    const std::size_t changes = ChangesBetween(word, candidate);
    if (changes > most || (!nearest.empty() && changes == most)) continue;
    most = changes;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace patchmill
