#include "cam/region/figures/leftover.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cam/region/reach/reach.h"

namespace patchmill {
namespace {

constexpr double kDepthResolution = 1e-3;  // in R: depths are not determined more finely
// Shares of the leftover. A place is examined if it may be deeper than the deepest one by kMinDepthGain and
// kDepthResolution. The search ends when none may be deeper by kProvenDepthGain and twice kDepthResolution.
constexpr double kMinDepthGain = 0.02, kProvenDepthGain = 0.05;
// At most kFewLooks places and one more for each square with a side of kSquare R are examined, and never more
// than kMostLooks.
constexpr double kFewLooks = 100.0, kMostLooks = 1000.0, kSquare = 0.1;
constexpr std::size_t kMostQuartered = 10000;  // cells
constexpr int kMostSettled = 8;                // calls of Settle in one search

}  // namespace

bool LeftoverSearch::Below(const Entry& a, const Entry& b) {
  return a.bound != b.bound ? a.bound < b.bound : a.cell > b.cell;
}

void LeftoverSearch::AddTriangle(std::size_t piece, const std::array<Vec2, 3>& uv) {
  SurfaceElement element = TriangleElement(locator_.surface(), piece, uv);
  area_ += 0.5 * (element.hull[1] - element.hull[0]).cross(element.hull[2] - element.hull[0]).norm();
  Add(std::move(element));
}

void LeftoverSearch::Push(std::size_t cell) {
  heap_.push_back({cells_[cell].bound, cell});
  std::push_heap(heap_.begin(), heap_.end(), Below);
}

std::size_t LeftoverSearch::Pop() {
  std::pop_heap(heap_.begin(), heap_.end(), Below);
  const std::size_t cell = heap_.back().cell;
  heap_.pop_back();
  return cell;
}

// Enters the cells that were added since the last call. The search begins with a centre right above each
// point.
void LeftoverSearch::EnterNew(const RunContext& run) {
  const std::size_t from = std::exchange(entered_, cells_.size());
  for (std::size_t i = from; i < cells_.size() && !run.Cancelled(); ++i) {
    const SurfaceElement& element = cells_[i].element;
    if (element.point) Learn(NearestCenter(locator_, params_, element.hull[0]).Above());
  }
  const double proven = Wanted().proven;
  for (std::size_t i = from; i < cells_.size(); ++i) {
    Bound(cells_[i], proven);
    heap_.push_back({cells_[i].bound, i});
  }
  std::make_heap(heap_.begin(), heap_.end(), Below);
}

// Lowers the cell's bound with the centres found, until it is at most `enough`. The centre that bounded the
// last cell is tried first, because it often serves the neighbour.
void LeftoverSearch::Bound(Cell& cell, double enough) {
  if (cell.seen == 0 && last_ < found_.size()) {
    cell.bound = Farthest(cell.element, found_[last_].center, cell.bound);
  }
  for (; cell.bound > enough; ++cell.seen) {
    cell.seen = centers_.FirstNear(cell.element.hull[0], cell.bound, cell.seen);
    if (cell.seen == found_.size()) return;
    const double farthest = Farthest(cell.element, found_[cell.seen].center, cell.bound);
    if (farthest >= cell.bound) continue;
    cell.bound = farthest;
    last_ = cell.seen;
  }
}

Column LeftoverSearch::NearestKnown(const Vec3& p) const {
  if (found_.empty()) return Column();
  std::size_t nearest = 0;
  double least = kInfinity;
  for (std::size_t i = 0; (i = centers_.FirstNear(p, least, i)) < found_.size(); ++i) {
    const double distance = (found_[i].center - p).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = i;
  }
  Column column = found_[nearest];
  column.distance = least;
  return column;
}

void LeftoverSearch::Learn(const Column& column) {
  if (column.distance == kInfinity) return;
  found_.push_back(column);
  centers_.Add(column.center);
  for (Looked& place : deepest_) {
    const double distance = (column.center - place.p).norm();
    if (distance >= place.nearest.distance) continue;
    place.nearest = column;
    place.nearest.distance = distance;
  }
}

void LeftoverSearch::LookAt(const ElementPlace& place, double enough) {
  const NearestCenter search(locator_, params_, place.p, enough);
  Column column = NearestKnown(place.p);
  const auto look = [&](const auto& further) {
    if (column.distance <= enough) return;
    const Column next = further();
    if (next.distance >= column.distance) return;
    column = next;
    Learn(column);
  };
  look([&] { return search.Above(column); });
  look([&] { return search.Descend(column); });
  if (place.facing) look([&] { return search.Beside(place.facing->e, column); });
  if (place.facing && place.facing->both) look([&] { return search.Beside(-place.facing->e, column); });
  look([&] { return search.FromAround(column); });
  ++looks_;
  if (column.distance > enough) deepest_.push_back({place.p, column});
}

const LeftoverSearch::Looked* LeftoverSearch::Worst() const {
  const auto worst = std::max_element(deepest_.begin(), deepest_.end(), [](const Looked& a, const Looked& b) {
    return a.nearest.distance < b.nearest.distance;
  });
  return worst == deepest_.end() ? nullptr : &*worst;
}

double LeftoverSearch::Distance() const {
  const Looked* const worst = Worst();
  return std::max(locator_.radius(), worst ? worst->nearest.distance : 0.0);
}

// Searches the nearest centre of the deepest place to the end. False if a much nearer one was found, because
// that one may be nearer to other places, too.
bool LeftoverSearch::Settle() {
  const Looked* const worst = Worst();
  const double radius = locator_.radius();
  if (worst == nullptr || settled_ >= kMostSettled || worst->nearest.distance == kInfinity ||
      worst->nearest.distance <= radius) {
    return true;
  }
  ++settled_;
  const double before = worst->nearest.distance;
  const Column settled = NearestCenter(locator_, params_, worst->p).Settle(worst->nearest);
  if (settled.distance < before) Learn(settled);
  const double fine = std::max(params_.fine, kDepthResolution * radius);
  return before - settled.distance <= kMinDepthGain * (settled.distance - radius) + fine;
}

LeftoverSearch::Limits LeftoverSearch::Wanted() const {
  const double radius = locator_.radius(), deepest = Distance();
  const double fine = std::max(params_.fine, kDepthResolution * radius);
  return {.enough = deepest + kMinDepthGain * (deepest - radius) + fine,
          .proven = deepest + kProvenDepthGain * (deepest - radius) + 2.0 * fine};
}

Deepest LeftoverSearch::Find(const RunContext& run) {
  const double radius = locator_.radius();
  const double most_looks = std::min(kMostLooks, kFewLooks + area_ / std::pow(kSquare * radius, 2));
  settled_ = 0;
  EnterNew(run);
  while (!heap_.empty() && !run.Cancelled()) {
    const Limits wanted = Wanted();
    if (heap_.front().bound <= wanted.proven) {
      if (Settle()) break;
      continue;
    }
    const std::size_t top = Pop();
    const double before = cells_[top].bound;
    Bound(cells_[top], wanted.proven);
    if (cells_[top].bound < before) {
      Push(top);
      continue;
    }
    const SurfaceElement& element = cells_[top].element;
    const ElementPlace middle = MiddleOf(locator_.surface(), element);
    const bool may_be = NearestKnown(middle.p).distance > wanted.enough;
    if (may_be ? looks_ >= most_looks : quartered_ >= kMostQuartered || element.point) {
      proven_ = false;
      continue;
    }
    if (may_be) {
      LookAt(middle, wanted.enough);
      Push(top);
      continue;
    }
    ++quartered_;
    for (SurfaceElement& quarter : Quarters(locator_.surface(), element)) {
      cells_.push_back({.element = std::move(quarter), .bound = before});
      Push(cells_.size() - 1);
    }
    entered_ = cells_.size();
  }
  const double all = locator_.surface().box.Diagonal();
  return {std::min(all, std::max(0.0, Distance() - radius)), proven_};
}

}  // namespace patchmill
