#include "cam/post/dialect.h"

#include <algorithm>
#include <cmath>

#include "core/base/status.h"

namespace patchmill {
namespace {

// The post files in cam/post/dialects, in the order of their names.
constexpr std::string_view kPostFiles[] = {
#include "cam/post/post_files.inc"
};

}  // namespace

const std::vector<Dialect>& Dialects() {
  static const auto* const dialects = [] {
    auto* all = new std::vector<Dialect>();
    for (const std::string_view text : kPostFiles) {
      absl::StatusOr<Dialect> dialect = ParseDialect(text);
      PM_CHECK(dialect.ok());  // tests read them all
      all->push_back(*std::move(dialect));
    }
    return all;
  }();
  return *dialects;
}

bool IsShipped(const Dialect& dialect) {
  const Dialect* const known = FindDialect(dialect.name);
  return known != nullptr && known->text == dialect.text;
}

const Dialect* FindDialect(std::string_view name) {
  for (const Dialect& dialect : Dialects()) {
    if (dialect.name == name) return &dialect;
  }
  return nullptr;
}

double TickOf(const Dialect& dialect, ProgramUnit unit) {
  return kMillimetersPer[unit] * std::pow(10.0, -dialect.decimals[unit]);
}

bool HasUnit(const Dialect& dialect, ProgramUnit unit) {
  return unit == ProgramUnit::kMillimeter || !dialect.unit_word[unit].empty();
}

const Dialect& LinuxCnc() { return *FindDialect("linuxcnc"); }

std::string DialectNames() {
  std::string list;
  for (const Dialect& dialect : Dialects()) list += (list.empty() ? "" : ", ") + dialect.name;
  return list;
}

}  // namespace patchmill
