// The machine of a job: a file such as docs/machine.json becomes settings, and settings become the message or
// a file again.
import { create, fromJson, type JsonValue, toJsonString } from "@bufbuild/protobuf";
import { Point3Schema } from "../gen/patchmill/v1/geometry_pb.js";
import { type Machine, type MachineAxis, MachineAxisSchema, MachineSchema } from "../gen/patchmill/v1/setup_pb.js";
import { type Choice, settings } from "./settings";
import { numberOf, numbersOf, pointOf, SettingError, wireText } from "./values";

export const axisNames = ["x", "y", "z"] as const;

// The values of an axis in the order of its setting, with their fields in the contract.
export const axisValues = [
  { label: "travel from", unit: "mm", field: "travel_min_mm" },
  { label: "travel to", unit: "mm", field: "travel_max_mm" },
  { label: "rapid", unit: "mm/min", field: "rapid_mm_per_min" },
  { label: "fastest feed", unit: "mm/min", field: "feed_mm_per_min" },
  { label: "acceleration", unit: "mm/s\u00b2", field: "acceleration_mm_per_s2" },
] as const;

export const machineSettings = settings.filter((s) => s.group === "machine").map((s) => s.name);

function makeAxis(choice: Choice, axis: string): MachineAxis {
  const name = `machine-${axis}`;
  const texts = choice.get(name).split(",");
  const missing = axisValues.filter((_, k) => (texts[k] ?? "").trim() === "").map((v) => v.label);
  if (missing.length > 0) {
    throw new SettingError(name, `The machine needs all values of axis ${axis.toUpperCase()}. Fill in ${missing.join(", ")}, or clear the machine.`);
  }
  const [from, to, rapid, feed, acceleration] = numbersOf(choice.get(name), [axisValues.length], name, "five numbers");
  return create(MachineAxisSchema, { travelMinMm: from!, travelMaxMm: to!, rapidMmPerMin: rapid!, feedMmPerMin: feed!, accelerationMmPerS2: acceleration! });
}

// The machine, or undefined if nothing of it is stated.
export function makeMachine(choice: Choice): Machine | undefined {
  if (!machineSettings.some((name) => choice.isSet(name))) return undefined;
  const machine = create(MachineSchema, { name: wireText(choice.get("machine-name"), 200), axes: axisNames.map((axis) => makeAxis(choice, axis)) });
  const corner = numberOf(choice, "machine-corner");
  if (corner !== undefined) machine.junctionDeviationMm = corner;
  const [spindle, zero] = [choice.get("machine-spindle"), choice.get("machine-zero")];
  if (spindle !== "") {
    const [least, most] = numbersOf(spindle, [2], "machine-spindle", "two speeds, SLOWEST,FASTEST");
    [machine.spindleMinRpm, machine.spindleMaxRpm] = [least!, most!];
  }
  if (zero !== "") machine.workZero = create(Point3Schema, pointOf(numbersOf(zero, [3], "machine-zero", "X,Y,Z")));
  return machine;
}

// Reads a machine file. It throws an error for the user if the file is none.
export function readMachine(name: string, text: string): Map<string, string> {
  let machine: Machine;
  try {
    machine = fromJson(MachineSchema, JSON.parse(text) as JsonValue);
  } catch (error) {
    throw new Error(`"${name}" is no machine in JSON, such as docs/machine.json: ${error instanceof Error ? error.message : ""}`);
  }
  if (machine.axes.length !== 3) throw new Error(`The machine of "${name}" has ${machine.axes.length} axes; it must have 3, X, Y and Z.`);
  const values = new Map<string, string>([["machine-name", machine.name.trim()]]);
  machine.axes.forEach((a, k) => {
    values.set(`machine-${axisNames[k]!}`, [a.travelMinMm, a.travelMaxMm, a.rapidMmPerMin, a.feedMmPerMin, a.accelerationMmPerS2].join(","));
  });
  if (machine.spindleMinRpm !== 0 || machine.spindleMaxRpm !== 0) values.set("machine-spindle", `${machine.spindleMinRpm},${machine.spindleMaxRpm}`);
  if (machine.junctionDeviationMm !== undefined) values.set("machine-corner", String(machine.junctionDeviationMm));
  if (machine.workZero !== undefined) values.set("machine-zero", [machine.workZero.xMm, machine.workZero.yMm, machine.workZero.zMm].join(","));
  return values;
}

// The machine as a file for --machine.
export function machineText(machine: Machine): string {
  return `${toJsonString(MachineSchema, machine, { useProtoFieldName: true, prettySpaces: 2, alwaysEmitImplicit: true })}\n`;
}
