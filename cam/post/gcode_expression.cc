#include "cam/post/gcode_expression.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/base/vec.h"

namespace patchmill {
namespace {

constexpr int kMostBrackets = 20;  // one in the other

absl::Status Bad(const std::string& message) { return absl::InvalidArgumentError(message); }

class Evaluator {
 public:
  Evaluator(std::string_view code, std::size_t& at) : code_(code), at_(at) {}

  absl::StatusOr<double> Value() {
    const bool minus = Take("-");
    if (!minus) Take("+");
    PM_ASSIGN_OR_RETURN(const double value, Unsigned());
    if (!std::isfinite(value)) return Bad("not a number in range");
    return minus ? -value : value;
  }

 private:
  bool Take(std::string_view text) {
    if (code_.substr(at_, text.size()) != text) return false;
    at_ += text.size();
    return true;
  }

  absl::StatusOr<double> Unsigned() {
    if (at_ >= code_.size()) return Bad("without a number");
    const char c = code_[at_];
    if (c == '#') return Bad("parameters are not supported");
    if (c == '[') return Bracket();
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) return Function();
    return Number();
  }

  // digits [. digits] with at least one digit. There is no exponent in RS274.
  absl::StatusOr<double> Number() {
    const std::size_t begin = at_;
    bool digits = false, point = false;
    for (; at_ < code_.size(); ++at_) {
      if (std::isdigit(static_cast<unsigned char>(code_[at_])) != 0) {
        digits = true;
      } else if (code_[at_] == '.' && !point) {
        point = true;
      } else {
        break;
      }
    }
    if (!digits) return Bad("without a number");
    const std::string_view text = code_.substr(begin, at_ - begin);
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
    if (error != std::errc() || end != text.data() + text.size()) {
      return Bad(fmt::format("{}: not a number in range", text.substr(0, 40)));
    }
    return value;
  }

  absl::StatusOr<double> Bracket() {
    if (!Take("[")) return Bad("a function without [");
    if (++depth_ > kMostBrackets) return Bad(fmt::format("brackets more than {} deep", kMostBrackets));
    PM_ASSIGN_OR_RETURN(const double value, Sum());
    if (!Take("]")) return Bad("an expression without ], or with an operator that is not supported");
    --depth_;
    return value;
  }

  absl::StatusOr<double> Sum() {
    PM_ASSIGN_OR_RETURN(double sum, Product());
    while (true) {
      const bool plus = Take("+");
      if (!plus && !Take("-")) return sum;
      PM_ASSIGN_OR_RETURN(const double next, Product());
      sum += plus ? next : -next;
    }
  }

  absl::StatusOr<double> Product() {
    PM_ASSIGN_OR_RETURN(double product, Power());
    while (true) {
      if (Take("*")) {
        PM_ASSIGN_OR_RETURN(const double next, Power());
        product *= next;
      } else if (Take("/")) {
        PM_ASSIGN_OR_RETURN(const double next, Power());
        product /= next;
      } else if (Take("MOD")) {
        PM_ASSIGN_OR_RETURN(const double next, Power());
        product -= next * std::floor(product / next);  // never negative for a positive divisor
      } else {
        return product;
      }
    }
  }

  absl::StatusOr<double> Power() {
    PM_ASSIGN_OR_RETURN(double power, Value());
    while (Take("**")) {
      PM_ASSIGN_OR_RETURN(const double next, Value());
      power = std::pow(power, next);
    }
    return power;
  }

  absl::StatusOr<double> Function() {
    if (Take("ATAN")) {
      PM_ASSIGN_OR_RETURN(const double y, Bracket());
      if (!Take("/")) return Bad("ATAN without /");
      PM_ASSIGN_OR_RETURN(const double x, Bracket());
      return Degrees(std::atan2(y, x));
    }
    using Of = double (*)(double);
    static constexpr std::pair<std::string_view, Of> kFunctions[] = {
        {"ABS", [](double x) { return std::abs(x); }},
        {"ACOS", [](double x) { return Degrees(std::acos(x)); }},
        {"ASIN", [](double x) { return Degrees(std::asin(x)); }},
        {"COS", [](double x) { return std::cos(Radians(x)); }},
        {"EXP", [](double x) { return std::exp(x); }},
        {"FIX", [](double x) { return std::floor(x); }},
        {"FUP", [](double x) { return std::ceil(x); }},
        {"LN", [](double x) { return std::log(x); }},
        {"ROUND", [](double x) { return std::round(x); }},
        {"SIN", [](double x) { return std::sin(Radians(x)); }},
        {"SQRT", [](double x) { return std::sqrt(x); }},
        {"TAN", [](double x) { return std::tan(Radians(x)); }},
    };
    for (const auto& [name, of] : kFunctions) {
      if (!Take(name)) continue;
      PM_ASSIGN_OR_RETURN(const double argument, Bracket());
      return of(argument);
    }
    return Bad("without a number");
  }

  std::string_view code_;
  std::size_t& at_;
  int depth_ = 0;
};

}  // namespace

absl::StatusOr<double> ReadGcodeValue(std::string_view code, std::size_t& at) {
  return Evaluator(code, at).Value();
}

}  // namespace patchmill
