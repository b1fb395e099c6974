#include "server/convert/machine.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/convert/setup.h"
#include "server/limits.h"

namespace patchmill {
namespace {

constexpr double kLeastAcceleration = 0.1, kMostAcceleration = 1e6;  // mm/s^2

MachineAxis ReadAxis(const v1::MachineAxis& proto, const std::string& at, FieldErrors& errors) {
  constexpr double kMost = limits::kMaxCoordinateMm;
  const auto check = [&](const char* name, double value, double least, double most) {
    Require(errors, At(at, name), value, value >= least && value <= most,
            fmt::format("in [{:g}, {:g}]", least, most));
    return value;
  };
  MachineAxis axis;
  axis.travel_min = check("travel_min_mm", proto.travel_min_mm(), -kMost, kMost);
  axis.travel_max = check("travel_max_mm", proto.travel_max_mm(), -kMost, kMost);
  if (axis.travel_max <= axis.travel_min) {
    errors.Add(At(at, "travel_max_mm"), fmt::format("= {:.10g}; must be above travel_min_mm = {:.10g}",
                                                    axis.travel_max, axis.travel_min));
  }
  axis.rapid = check("rapid_mm_per_min", proto.rapid_mm_per_min(), limits::kMinFeed, limits::kMaxFeed);
  axis.feed = check("feed_mm_per_min", proto.feed_mm_per_min(), limits::kMinFeed, limits::kMaxFeed);
  axis.acceleration =
      check("acceleration_mm_per_s2", proto.acceleration_mm_per_s2(), kLeastAcceleration, kMostAcceleration);
  return axis;
}

}  // namespace

Machine FromProto(const v1::Machine& proto, std::string_view at, FieldErrors& errors) {
  Machine machine;
  RequireBytes(errors, At(at, "name"), proto.name(), limits::kMaxIdBytes);
  machine.name = proto.name();
  if (proto.axes_size() != 3) {
    errors.Add(At(at, "axes"), fmt::format("has {} elements; must have 3, X, Y and Z", proto.axes_size()));
    return machine;
  }
  for (int k = 0; k < 3; ++k) {
    machine.axes[static_cast<std::size_t>(k)] =
        ReadAxis(proto.axes(k), fmt::format("{}[{}]", At(at, "axes"), k), errors);
  }
  if (proto.has_junction_deviation_mm()) {
    machine.junction_deviation = proto.junction_deviation_mm();
    Require(errors, At(at, "junction_deviation_mm"), machine.junction_deviation,
            machine.junction_deviation >= 0.0 && machine.junction_deviation <= 1.0, "in [0, 1]");
  }
  const auto speed = [&](const char* name, double value) {
    Require(errors, At(at, name), value, value >= 0.0 && value <= limits::kMaxRpm,
            fmt::format("in [0, {:g}]", limits::kMaxRpm));
    return value;
  };
  machine.spindle_min = speed("spindle_min_rpm", proto.spindle_min_rpm());
  machine.spindle_max = speed("spindle_max_rpm", proto.spindle_max_rpm());
  if (machine.spindle_max > 0.0 && machine.spindle_max < machine.spindle_min) {
    errors.Add(At(at, "spindle_max_rpm"), fmt::format("= {:.10g}; must be at least spindle_min_rpm = {:.10g}",
                                                      machine.spindle_max, machine.spindle_min));
  }
  if (proto.has_work_zero()) machine.work_zero = ReadPoint(proto.work_zero(), At(at, "work_zero"), errors);
  return machine;
}

v1::Machine ToProto(const Machine& machine) {
  v1::Machine proto;
  proto.set_name(Utf8(machine.name));
  for (const MachineAxis& axis : machine.axes) {
    v1::MachineAxis& to = *proto.add_axes();
    to.set_travel_min_mm(axis.travel_min);
    to.set_travel_max_mm(axis.travel_max);
    to.set_rapid_mm_per_min(axis.rapid);
    to.set_feed_mm_per_min(axis.feed);
    to.set_acceleration_mm_per_s2(axis.acceleration);
  }
  proto.set_junction_deviation_mm(machine.junction_deviation);
  proto.set_spindle_min_rpm(machine.spindle_min);
  proto.set_spindle_max_rpm(machine.spindle_max);
  if (machine.work_zero) *proto.mutable_work_zero() = ToProto(*machine.work_zero);
  return proto;
}

}  // namespace patchmill
