#include "cam/post/word_rules.h"

#include <algorithm>

namespace patchmill {
namespace {

const WordRule* FindIn(std::span<const WordRule> rules, char letter, int code) {
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const WordRule& rule) {
    return rule.letter == letter && code >= rule.first && code <= std::max(rule.first, rule.last);
  });
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace

std::span<const WordRule> WordsOf(WordFamily family) {
  switch (family) {
    case WordFamily::kNone:
      return {};
    case WordFamily::kLinuxCnc:
      return LinuxCncWords();
    case WordFamily::kGrbl:
      return GrblWords();
    case WordFamily::kFanuc:
      return FanucWords();
    case WordFamily::kHaas:
      return HaasWords();
    case WordFamily::kMach3:
      return Mach3Words();
    case WordFamily::kSiemens:
      return SiemensWords();
    case WordFamily::kHeidenhain:
      return HeidenhainWords();
  }
  return {};
}

const WordRule* FindWordRule(WordFamily family, char letter, int code) {
  const WordRule* const own = FindIn(WordsOf(family), letter, code);
  if (own != nullptr || family == WordFamily::kHeidenhain) return own;
  return FindIn(CommonWords(), letter, code);
}

std::optional<WordFamily> FamilyOf(std::string_view name) {
  constexpr std::pair<std::string_view, WordFamily> kFamilies[] = {
      {"linuxcnc", WordFamily::kLinuxCnc},    {"grbl", WordFamily::kGrbl},
      {"fanuc", WordFamily::kFanuc},          {"haas", WordFamily::kHaas},
      {"mach3", WordFamily::kMach3},          {"siemens", WordFamily::kSiemens},
      {"heidenhain", WordFamily::kHeidenhain}};
  for (const auto& [known, family] : kFamilies) {
    if (known == name) return family;
  }
  return std::nullopt;
}

}  // namespace patchmill
