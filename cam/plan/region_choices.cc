#include "cam/plan/region_choices.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "cam/region/map/regions_digest.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kPickProof = 1e-4;  // mm: how exactly the nearest place is known

std::string Path(std::size_t k) { return fmt::format("region_overrides[{}]", k); }

absl::StatusOr<RegionId> FindRegion(const Surface& surface, const RegionMap& map,
                                    const RegionOverride& change, const std::string& path, const Vec3& zero) {
  const int count = static_cast<int>(map.regions.size());
  if (!change.at) {
    if (change.region.value >= 0 && change.region.value < count) return change.region;
    return FieldError(path + ".region_id", fmt::format("= {}; must be in [0, {}], a region of the map",
                                                       change.region.value, count - 1));
  }
  const auto nearest = ClosestToPoint(surface, *change.at + zero, kPickReach, kPickProof);
  const RegionId id = nearest ? map.At(nearest->at) : kNoRegion;
  if (id != kNoRegion) return id;
  return FieldError(path + ".at", fmt::format("= {:.4f} {:.4f} {:.4f}; must lie within {} mm of a region",
                                              change.at->x(), change.at->y(), change.at->z(), kPickReach));
}

// By id: whether a cell of the map is the region's.
std::vector<bool> WithCells(const RegionMap& map) {
  std::vector<bool> with(map.regions.size(), false);
  for (const std::vector<RegionId>& labels : map.labels)
    for (const RegionId id : labels)
      if (id != kNoRegion) with[id.index()] = true;
  return with;
}

// Which region each cell of a piece follows: its own when that is reachable or skipped, else the reachable
// one that the fewest steps from cell to cell lead to; kNoRegion where there is none.
std::vector<RegionId> Leaders(const RegionMap& map, const std::vector<RegionId>& labels,
                              const std::vector<RegionChoice>& choices) {
  const int n = map.cells;
  std::vector<RegionId> leader(labels.size(), kNoRegion);
  std::deque<int> queue;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (labels[k] == kNoRegion) continue;
    const std::size_t id = labels[k].index();
    const bool reachable = map.regions[id].kind != RegionKind::kUnreachable;
    if (!reachable && !choices[id].skip) continue;
    leader[k] = labels[k];
    if (reachable) queue.push_back(static_cast<int>(k));
  }
  while (!queue.empty()) {
    const int k = queue.front(), i = k / n, j = k % n;
    queue.pop_front();
    const auto step = [&](int a, int b) {
      if (a < 0 || b < 0 || a >= n || b >= n) return;
      RegionId& to = leader[static_cast<std::size_t>(a * n + b)];
      if (to != kNoRegion) return;
      to = leader[static_cast<std::size_t>(k)];
      queue.push_back(a * n + b);
    };
    step(i - 1, j);
    step(i + 1, j);
    step(i, j - 1);
    step(i, j + 1);
  }
  return leader;
}

// The cells of a piece that belong to the component or are at most kCellsBesideCircles steps from cell to
// cell away. Its border runs through cells: without these, short ends of other lines would cut their
// remainders.
std::vector<bool> CellsOf(const RegionMap& map, std::size_t piece, ComponentId component) {
  const int n = map.cells;
  std::vector<bool> own(map.labels[piece].size());
  std::vector<int> edge;
  for (std::size_t k = 0; k < own.size(); ++k) {
    own[k] = map.ComponentAt(piece, k) == component;
    if (own[k]) edge.push_back(static_cast<int>(k));
  }
  for (int step = 0; step < kCellsBesideCircles; ++step) {
    std::vector<int> next;
    for (const int k : edge) {
      const int i = k / n, j = k % n;
      for (const auto& [a, b] : {std::pair(i - 1, j), {i + 1, j}, {i, j - 1}, {i, j + 1}}) {
        if (a < 0 || b < 0 || a >= n || b >= n || own[static_cast<std::size_t>(a * n + b)]) continue;
        own[static_cast<std::size_t>(a * n + b)] = true;
        next.push_back(a * n + b);
      }
    }
    edge = std::move(next);
  }
  return own;
}

// Which pieces have cells of each component.
std::map<ComponentId, std::vector<std::size_t>> PiecesOfComponents(const RegionMap& map) {
  std::map<ComponentId, std::vector<std::size_t>> pieces;
  for (std::size_t piece = 0; piece < map.labels.size(); ++piece) {
    ComponentId last = kNoComponent;
    for (std::size_t cell = 0; cell < map.labels[piece].size(); ++cell) {
      const ComponentId component = map.ComponentAt(piece, cell);
      if (component == last) continue;
      last = component;
      std::vector<std::size_t>& own = pieces[component];
      if (own.empty() || own.back() != piece) own.push_back(piece);
    }
  }
  return pieces;
}

// mm: circles around centres this near to each other are one family. Any distance would be safe, because
// steps are measured along the circles as they lie; a larger one would make passes longer.
constexpr double kSamePlace = 0.05;

std::vector<PlanPart> WithCircularLines(const RegionMap& map, const std::vector<RegionChoice>& choices,
                                        const std::vector<int>& part_of, std::vector<PlanPart> parts) {
  using Cells = std::vector<std::vector<bool>>;
  if (std::all_of(choices.begin(), choices.end(), [](const RegionChoice& c) { return c.around.empty(); }))
    return parts;
  std::map<ComponentId, std::vector<std::size_t>> pieces_of = PiecesOfComponents(map);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::vector<CircularLines> families;
    std::vector<Cells> cells;
    for (std::size_t id = 0; id < choices.size(); ++id) {
      if (part_of[id] != static_cast<int>(p)) continue;
      for (const auto& [component, own] : choices[id].around) {
        std::size_t k = 0;
        while (k < families.size() && (families[k].center - own.center).norm() > kSamePlace) ++k;
        if (k == families.size()) {
          families.push_back(own);
          cells.emplace_back(map.labels.size());
        }
        families[k].inner = std::min(families[k].inner, own.inner);
        families[k].outer = std::max(families[k].outer, own.outer);
        for (const std::size_t piece : pieces_of[component]) {
          std::vector<bool> more = CellsOf(map, piece, component);
          std::vector<bool>& in = cells[k][piece];
          if (in.empty()) {
            in = std::move(more);
          } else {
            std::transform(in.begin(), in.end(), more.begin(), in.begin(), std::logical_or<>());
          }
        }
      }
    }
    if (families.empty()) continue;
    // Beside two families cells are the first one's.
    Cells straight(map.labels.size());
    for (std::size_t piece = 0; piece < straight.size(); ++piece) {
      straight[piece].resize(map.labels[piece].size(), true);
      for (Cells& own : cells) {
        if (std::find(own[piece].begin(), own[piece].end(), true) == own[piece].end()) continue;
        for (std::size_t i = 0; i < own[piece].size(); ++i) {
          own[piece][i] = own[piece][i] && straight[piece][i];
          if (own[piece][i]) straight[piece][i] = false;
        }
      }
    }
    for (std::size_t k = 0; k < families.size(); ++k)
      parts[p].round.push_back({families[k], std::make_shared<const SurfaceMask>(map.cells, cells[k])});
    parts[p].straight = std::make_shared<const SurfaceMask>(map.cells, straight);
  }
  return parts;
}

}  // namespace

bool CutTogether(const RegionChoice& a, const RegionChoice& b) {
  RegionChoice c = b;
  c.around = a.around;
  if (a.all_circular || b.all_circular) {
    c.zigzag_angle = a.zigzag_angle;
    c.all_circular = a.all_circular;
  }
  return a == c;
}

RegionChoice ChoiceOf(const Operation& op) {
  RegionChoice choice;
  choice.strategy = op.strategy;
  choice.zigzag_angle = op.zigzag_angle;
  choice.one_way = op.one_way;
  choice.scallop = op.scallop;
  return choice;
}

OpenChoice OpenOf(const Operation& op) {
  return {.angle = op.angle_auto && op.strategy != Strategy::kContour, .circles = op.round_lines};
}

ForcedSteps ForcedOf(const RegionChoice& choice) {
  ForcedSteps forced;
  if (choice.strategy == Strategy::kContour) forced.passes = ForcedPasses::kContours;
  if (choice.strategy == Strategy::kZigzag) forced.passes = ForcedPasses::kLines;
  forced.angle = choice.zigzag_angle;
  return forced;
}

absl::StatusOr<RegionChoices> ChooseRegions(const Surface& surface, const RegionMap& map, const Operation& op,
                                            const Vec3& program_zero) {
  if (!op.regions_sha256.empty()) {
    if (const std::string now = RegionsDigest(map); now != op.regions_sha256) {
      return absl::FailedPreconditionError(fmt::format(
          "regions_sha256 = {}; the regions of this job have {}: they were made for another "
          "model, set-up, tool or shank, stock to leave, tolerance, steep angle, detail, floor, "
          "highest tip, obstacles, selection, forced strategy or angle of lines; ask for them again",
          Hex(op.regions_sha256), Hex(now)));
    }
  }
  RegionChoices chosen{std::vector<RegionChoice>(map.regions.size(), ChoiceOf(op)),
                       std::vector<OpenChoice>(map.regions.size(), OpenOf(op))};
  if (op.overrides.empty()) return chosen;
  std::vector<bool> named(map.regions.size(), false);
  const std::vector<bool> with_cells = WithCells(map);
  for (std::size_t k = 0; k < op.overrides.size(); ++k) {
    const RegionOverride& change = op.overrides[k];
    PM_ASSIGN_OR_RETURN(const RegionId region, FindRegion(surface, map, change, Path(k), program_zero));
    const std::size_t id = region.index();
    if (named[id]) {
      return FieldError(Path(k), fmt::format("names region {} a second time", region.value));
    }
    named[id] = true;
    if (map.regions[id].kind == RegionKind::kUnreachable && !change.skip) {
      return FieldError(Path(k), fmt::format("names region {}, which is unreachable; it can only be skipped",
                                             region.value));
    }
    if (!with_cells[id]) {
      return FieldError(
          Path(k),
          fmt::format("names region {} of {:.3g} mm2, which is too small to be cut apart from what is "
                      "around it (regions are told apart on {} x {} cells of each patch)",
                      region.value, map.regions[id].area, map.cells, map.cells));
    }
    RegionChoice& choice = chosen.choices[id];
    OpenChoice& open = chosen.open[id];
    choice.skip = change.skip;
    choice.strategy = change.strategy.value_or(choice.strategy);
    choice.zigzag_angle = change.zigzag_angle.value_or(choice.zigzag_angle);
    open.angle = op.angle_auto && !change.zigzag_angle && choice.strategy != Strategy::kContour;
    open.circles = open.circles && !change.zigzag_angle;
    choice.one_way = change.one_way.value_or(choice.one_way);
    choice.scallop = change.scallop.value_or(choice.scallop);
  }
  return chosen;
}

std::vector<PlanPart> PartsOf(const RegionMap& map, const std::vector<RegionChoice>& choices) {
  std::vector<PlanPart> parts;
  std::vector<int> part_of(choices.size(), -1);
  for (const bool round : {false, true}) {
    for (std::size_t id = 0; id < choices.size(); ++id) {
      if (choices[id].skip || map.regions[id].kind == RegionKind::kUnreachable) continue;
      if (choices[id].all_circular != round) continue;
      const auto known = std::find_if(parts.begin(), parts.end(), [&](const PlanPart& part) {
        return CutTogether(choices[id], part.choice);
      });
      part_of[id] = static_cast<int>(known - parts.begin());
      if (known != parts.end()) continue;
      parts.emplace_back().choice = choices[id];
      parts.back().choice.around.clear();
      parts.back().choice.all_circular = false;
    }
  }
  const bool any_skipped =
      std::any_of(choices.begin(), choices.end(), [](const RegionChoice& c) { return c.skip; });
  if (parts.empty()) parts.emplace_back();
  if (parts.size() == 1 && !any_skipped) return WithCircularLines(map, choices, part_of, std::move(parts));
  using Cells = std::vector<std::vector<bool>>;
  std::vector<Cells> marked(parts.size(), Cells(map.labels.size()));
  for (std::size_t piece = 0; piece < map.labels.size(); ++piece) {
    const std::vector<RegionId> leader = Leaders(map, map.labels[piece], choices);
    for (Cells& cells : marked) cells[piece].resize(leader.size(), false);
    for (std::size_t k = 0; k < leader.size(); ++k) {
      // Pieces that the ball does not reach belong to the first part: each has to belong to one.
      const int part = leader[k] == kNoRegion ? 0 : part_of[leader[k].index()];
      if (part >= 0) marked[static_cast<std::size_t>(part)][piece][k] = true;
    }
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    parts[p].where = std::make_shared<const SurfaceMask>(map.cells, marked[p]);
  }
  return WithCircularLines(map, choices, part_of, std::move(parts));
}

std::shared_ptr<const SurfaceMask> CutCells(const RegionMap& map, const std::vector<RegionChoice>& choices,
                                            const std::vector<PlanPart>& parts) {
  if (std::none_of(choices.begin(), choices.end(), [](const RegionChoice& c) { return c.skip; }))
    return nullptr;
  std::vector<std::vector<bool>> cells(map.labels.size());
  for (std::size_t piece = 0; piece < cells.size(); ++piece) {
    cells[piece].resize(map.labels[piece].size());
    for (std::size_t k = 0; k < cells[piece].size(); ++k) {
      const int i = static_cast<int>(k) / map.cells, j = static_cast<int>(k) % map.cells;
      cells[piece][k] = std::any_of(parts.begin(), parts.end(), [&](const PlanPart& part) {
        return part.where == nullptr || part.where->HasCell(PieceId(piece), i, j);
      });
    }
  }
  return std::make_shared<const SurfaceMask>(map.cells, cells);
}

}  // namespace patchmill
