#include "cam/plan/patch_selection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include <absl/strings/numbers.h>
#include <fmt/format.h>

#include "core/base/enum_array.h"
#include "core/base/error_details.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostListed = 8;  // values that a message lists

// The first characters of a text from a file or a client, without those that move the cursor of a terminal.
std::string Shown(const std::string& text) {
  constexpr std::size_t kMost = 50;  // bytes
  std::size_t end = std::min(text.size(), kMost);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  std::string shown = text.substr(0, end);
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return shown;
}

// "plane, cylinder and 3 more".
std::string Listed(const std::set<std::string>& values) {
  std::string text;
  std::size_t count = 0;
  for (const std::string& value : values) {
    if (count++ == kMostListed) return text + fmt::format(" and {} more", values.size() - kMostListed);
    text += (text.empty() ? "" : ", ") + Shown(value);
  }
  return text;
}

std::string ColorText(const ModelFace& face) {
  return face.rgb ? fmt::format("#{:06x}", *face.rgb) : std::string();
}

// A property that "KEY=VALUE" compares.
struct Property {
  std::string_view key;
  std::string (*of)(const ModelFace&);
};
constexpr std::array<Property, 5> kProperties = {{
    {"name=", [](const ModelFace& face) { return face.name; }},
    {"body=", [](const ModelFace& face) { return face.body; }},
    {"layer=", [](const ModelFace& face) { return face.layer; }},
    {"color=", &ColorText},
    {"kind=", [](const ModelFace& face) { return std::string(Name(face.kind)); }},
}};

// For each face the faces beside it across smooth edges.
std::vector<std::vector<std::size_t>> SmoothNeighbors(const PatchNetwork& network) {
  std::vector<std::vector<std::size_t>> beside(network.model.faces.size());
  const auto join = [&](PatchId one, PatchId two) {
    const std::optional<FaceId> a = network.model.patches[one.index()].face;
    const std::optional<FaceId> b = network.model.patches[two.index()].face;
    if (!a || !b || a == b) return;
    beside[a->index()].push_back(b->index());
    beside[b->index()].push_back(a->index());
  };
  for (const EdgeLink& link : network.edges) {
    if (link.neighbor && link.max_angle <= kTangentBreak) join(link.self.patch, link.neighbor->patch);
  }
  for (const PartLink& link : network.part_links) {
    if (link.max_angle <= kTangentBreak) join(link.part.patch, link.whole.patch);
  }
  return beside;
}

class Selector {
 public:
  explicit Selector(const PatchNetwork& network) : model_(network.model), beside_(SmoothNeighbors(network)) {
    for (std::size_t i = 0; i < model_.patches.size(); ++i) {
      if (!model_.patches[i].id.empty()) patches_.emplace(model_.patches[i].id, i);
    }
    for (std::size_t f = 0; f < model_.faces.size(); ++f) faces_.emplace(model_.faces[f].id, f);
  }

  // Sets the flags of what `name` selects. Else says what is wrong with it: "must be ...".
  std::optional<std::string> Add(const std::string& name, std::vector<bool>& selected) const {
    if (const auto patch = patches_.find(name); patch != patches_.end()) {
      selected[patch->second] = true;
      return std::nullopt;
    }
    int index = -1;
    if (name.starts_with('#') && absl::SimpleAtoi(name.substr(1), &index)) {
      if (index < 0 || static_cast<std::size_t>(index) >= selected.size()) return Expected();
      selected[static_cast<std::size_t>(index)] = true;
      return std::nullopt;
    }
    if (model_.faces.empty()) return Expected();
    std::vector<bool> faces(model_.faces.size(), true);
    std::size_t begin = 0;
    while (begin <= name.size()) {
      const std::size_t end = std::min(name.find('&', begin), name.size());
      if (auto wrong = Keep(name.substr(begin, end - begin), faces)) return wrong;
      begin = end + 1;
    }
    bool any = false;
    for (std::size_t i = 0; i < selected.size(); ++i) {
      const std::optional<FaceId> face = model_.patches[i].face;
      if (!face || !faces[face->index()]) continue;
      selected[i] = any = true;
    }
    if (!any) return "must select a face that has patches: no such face meets all its conditions";
    return std::nullopt;
  }

 private:
  std::string Expected() const {
    std::string text = fmt::format("must be a patch id of the model or #0 to #{}", model_.patches.size() - 1);
    if (model_.faces.empty()) return text;
    return text +
           fmt::format(
               ", a face id ({} to {}; {}+ takes its smooth neighbours, too), or name=, body=, layer=, "
               "color=, kind=, radius<=, radius>=",
               model_.faces.front().id, model_.faces.back().id, model_.faces.front().id);
  }

  // Keeps those of `faces` that meet one condition.
  std::optional<std::string> Keep(const std::string& condition, std::vector<bool>& faces) const {
    for (const Property& property : kProperties) {
      if (condition.starts_with(property.key)) return KeepProperty(property, condition, faces);
    }
    if (condition.starts_with("radius")) return KeepRadius(condition, faces);
    std::string id = condition;
    if (id.starts_with("face:")) id.erase(0, 5);
    auto face = faces_.find(id);
    const bool chain = face == faces_.end() && id.ends_with('+');
    if (chain) face = faces_.find(id.substr(0, id.size() - 1));
    if (face == faces_.end()) return Expected();
    const std::vector<bool> wanted = chain ? SmoothlyJoined(face->second) : [&] {
      std::vector<bool> one(faces.size(), false);
      one[face->second] = true;
      return one;
    }();
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = faces[f] && wanted[f];
    return std::nullopt;
  }

  std::optional<std::string> KeepProperty(const Property& property, const std::string& condition,
                                          std::vector<bool>& faces) const {
    std::string value = condition.substr(property.key.size());
    if (property.key == "color=") {
      std::transform(value.begin(), value.end(), value.begin(),
                     [](char c) { return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c; });
    }
    bool any = false;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const bool same = !value.empty() && property.of(model_.faces[f]) == value;
      any = any || same;
      faces[f] = faces[f] && same;
    }
    if (any) return std::nullopt;
    std::set<std::string> known;
    for (const ModelFace& face : model_.faces) known.insert(property.of(face));
    known.erase("");
    const std::string_view name = property.key.substr(0, property.key.size() - 1);
    if (known.empty())
      return fmt::format("must be a property that the model's faces have: none has a {}", name);
    return fmt::format("must be one that the model has: {} is one of {}", name, Listed(known));
  }

  std::optional<std::string> KeepRadius(const std::string& condition, std::vector<bool>& faces) const {
    const std::string relation = condition.substr(6, 2);
    double limit = 0.0;
    if ((relation != "<=" && relation != ">=") || !absl::SimpleAtod(condition.substr(8), &limit) ||
        !std::isfinite(limit)) {
      return "must compare radii as in radius<=3 or radius>=3, in mm";
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const double radius = model_.faces[f].radius;
      faces[f] = faces[f] && radius > 0.0 && (relation == "<=" ? radius <= limit : radius >= limit);
    }
    return std::nullopt;
  }

  // The face, and all faces that smooth edges lead to from it.
  std::vector<bool> SmoothlyJoined(std::size_t face) const {
    std::vector<bool> met(model_.faces.size(), false);
    std::vector<std::size_t> open = {face};
    met[face] = true;
    while (!open.empty()) {
      const std::size_t from = open.back();
      open.pop_back();
      for (const std::size_t to : beside_[from]) {
        if (met[to]) continue;
        met[to] = true;
        open.push_back(to);
      }
    }
    return met;
  }

  const PatchModel& model_;
  std::vector<std::vector<std::size_t>> beside_;  // faces beside each face across smooth edges
  std::unordered_map<std::string, std::size_t> patches_, faces_;
};

}  // namespace

absl::StatusOr<std::vector<bool>> SelectPatches(const PatchNetwork& network,
                                                const std::vector<std::string>& names, std::string_view field,
                                                const RunContext& run) {
  std::vector<bool> selected;
  if (names.empty()) return selected;
  const Selector selector(network);
  selected.resize(network.model.patches.size(), false);
  for (std::size_t k = 0; k < names.size(); ++k) {
    PM_RETURN_IF_ERROR(run.Check());
    if (const auto wrong = selector.Add(names[k], selected)) {
      return FieldError(fmt::format("{}[{}]", field, k),
                        fmt::format("= \"{}\"; {}", Shown(names[k]), *wrong));
    }
  }
  return selected;
}

}  // namespace patchmill
