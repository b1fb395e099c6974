#include "clients/cli/stock_option.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "clients/cli/job_options.h"
#include "clients/cli/limit_options.h"

namespace patchmill::cli {
namespace {

// Reads the numbers of ",1,2". False if there is something else, or another count than `least` to `most`.
bool ReadNumbers(const std::string& text, std::size_t least, std::size_t most, std::vector<double>& numbers) {
  std::size_t at = 0;
  while (at < text.size()) {
    if (text[at] != ',') return false;
    const std::size_t end = std::min(text.find(',', at + 1), text.size());
    double value = 0.0;
    if (!ReadFinite(text.substr(at + 1, end - at - 1), value)) return false;
    numbers.push_back(value);
    at = end;
  }
  return numbers.size() >= least && numbers.size() <= most;
}

}  // namespace

absl::Status ReadStockBody(const std::string& text, const ReadingOptions& reading, v1::Stock& stock) {
  const std::size_t end = std::min(text.find_first_of(",:"), text.size());
  const std::string kind = text.substr(0, end), rest = text.substr(end);
  std::vector<double> numbers;
  if (kind == "block" && ReadNumbers(rest, 0, 1, numbers)) {
    stock.mutable_block()->set_margin_mm(numbers.empty() ? 0.0 : numbers[0]);
    return absl::OkStatus();
  }
  if (kind == "cylinder" && ReadNumbers(rest, 1, 3, numbers) && numbers.size() != 2) {
    stock.mutable_cylinder()->set_diameter_mm(numbers[0]);
    for (std::size_t k = 1; k < numbers.size(); ++k) stock.mutable_cylinder()->add_center_xy_mm(numbers[k]);
    return absl::OkStatus();
  }
  if (kind == "outline" && !rest.empty() && rest.front() == ':') {
    const std::size_t points = rest.find_first_not_of(' ', 1);
    return ReadRing(points == std::string::npos ? "" : rest.substr(points), "--stock",
                    stock.mutable_outline()->mutable_outline_xy_mm());
  }
  if (kind == "model" && rest.size() > 1 && rest.front() == ':') {
    absl::StatusOr<v1::ModelSource> model = ReadModelFile(rest.substr(1), reading);
    if (!model.ok()) return model.status();
    *stock.mutable_model() = *std::move(model);
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      fmt::format("--stock \"{}\"; must be block[,MARGIN], cylinder,D[,X,Y], \"outline: X,Y X,Y X,Y\", "
                  "outline:@FILE or model:FILE",
                  text.substr(0, 80)));
}

}  // namespace patchmill::cli
