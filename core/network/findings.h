// Collects coded findings about edges and patches, at most 1000 of each code.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/base/diagnostic.h"
#include "core/network/edge_curves.h"

namespace patchmill {

class NetworkFindings {
 public:
  NetworkFindings(const PatchModel& model, const EdgeCurves& curves) : model_(model), curves_(curves) {}

  // "edge 2 of patch 7" or, with an id, "edge 2 of patch 7 (lid)"; "an edge of face f12 (pocket floor)".
  std::string Name(int edge) const;
  std::string Name(PatchId patch) const;
  // `message` is a function that makes the text. It is called only while there is room.
  template <class Message>
  void AtEdge(std::string_view code, Severity severity, int edge, const Message& message) {
    if (HasRoom(code)) Add(code, severity, WhereIs(edge), message());
  }
  template <class Message>
  void AtPatch(std::string_view code, Severity severity, PatchId patch, const Message& message) {
    if (HasRoom(code)) Add(code, severity, WhereIs(patch), message());
  }
  void AtPoint(std::string_view code, Severity severity, const Vec3& point, std::string message);

  Diagnostics Take();  // by code, then in order of arrival

 private:
  bool HasRoom(std::string_view code);  // counts the finding as dropped if there is none
  Where WhereIs(int edge) const;        // at the middle of the edge
  Where WhereIs(PatchId patch) const;   // at the middle of the patch
  void Add(std::string_view code, Severity severity, Where where, std::string message);

  const PatchModel& model_;
  const EdgeCurves& curves_;
  struct List {
    Diagnostics kept;
    int dropped = 0;
  };
  std::map<std::string, List, std::less<>> by_code_;
};

}  // namespace patchmill
