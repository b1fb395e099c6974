// The units of length that options name.
#pragma once

#include <map>
#include <string>

#include "patchmill/v1/model.pb.h"

namespace patchmill::cli {

inline const std::map<std::string, v1::LengthUnit>& LengthUnits() {
  static const std::map<std::string, v1::LengthUnit> kUnits = {
      {"mm", v1::LENGTH_UNIT_MILLIMETER}, {"inch", v1::LENGTH_UNIT_INCH}, {"m", v1::LENGTH_UNIT_METER}};
  return kUnits;
}

}  // namespace patchmill::cli
