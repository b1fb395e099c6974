// The machine tool that runs a program: travel, speeds and accelerations of its axes.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/base/vec.h"

namespace patchmill {

struct MachineAxis {
  double travel_min = 0.0, travel_max = 0.0;  // mm, machine coordinates
  double rapid = 0.0, feed = 0.0;             // mm/min, the fastest of each
  double acceleration = 0.0;                  // mm/s^2
};

struct Machine {
  std::string name;
  std::array<MachineAxis, 3> axes;  // X, Y, Z
  // mm: how far the control may leave a corner of the path without stopping there; 0: it stops.
  double junction_deviation = 0.01;
  double spindle_min = 0.0, spindle_max = 0.0;  // 1/min; max 0: not known
  // The program zero in machine coordinates, mm, where it is known.
  std::optional<Vec3> work_zero;
};

}  // namespace patchmill
