// Writes coded findings about a curve network, at most 1000 of each code.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

class NetworkWriter {
 public:
  NetworkWriter(const CurveNetwork& network, Diagnostics& to) : network_(network), to_(to) {}

  Where AtVertex(int vertex) const;
  Where AtEdge(int edge) const;  // entry of CurveNetwork::edges, or the line it was made from
  Where AtLine(int line) const;
  Where AtControl(int control) const;
  Where AtFace(int face) const;

  // The message becomes "<path> <text>".
  void Error(std::string_view code, Where where, std::string_view text) const {
    Add(code, Severity::kError, std::move(where), text);
  }
  bool ErrorWritten() const;
  void Warning(std::string_view code, Where where, std::string_view text) const {
    Add(code, Severity::kWarning, std::move(where), text);
  }

 private:
  void Add(std::string_view code, Severity severity, Where where, std::string_view text) const;

  const CurveNetwork& network_;
  Diagnostics& to_;
  mutable std::map<std::string, int, std::less<>> count_;
};

bool HasError(const Diagnostics& findings);

}  // namespace patchmill
