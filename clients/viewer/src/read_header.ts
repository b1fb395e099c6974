// Checks the JSON header of a scene field by field. A damaged header gives a SceneError that names the field.
import { type Header, type Point3, SceneError } from "./scene";

type Json = Record<string, unknown>;
type Read<T> = (value: unknown, field: string) => T;

const fail = (field: string, wanted: string): never => {
  throw new SceneError(`The field "${field}" of the header must be ${wanted}.`);
};

const text: Read<string> = (value, field) => (typeof value === "string" ? value : fail(field, "a text"));
const number: Read<number> = (value, field) =>
  typeof value === "number" && Number.isFinite(value) ? value : fail(field, "a finite number");
const positive: Read<number> = (value, field) => (number(value, field) > 0 ? (value as number) : fail(field, "above 0"));
const count: Read<number> = (value, field) =>
  Number.isInteger(value) && (value as number) >= 0 ? (value as number) : fail(field, "a whole number from 0 on");
const object: Read<Json> = (value, field) =>
  typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Json) : fail(field, "an object");
const list =
  <T>(item: Read<T>): Read<T[]> =>
  (value, field) =>
    Array.isArray(value) ? value.map((v, i) => item(v, `${field}[${i}]`)) : fail(field, "a list");
const orNull =
  <T>(item: Read<T>): Read<T | null> =>
  (value, field) =>
    value === null || value === undefined ? null : item(value, field);
const tuple =
  <T>(item: Read<T>, size: number): Read<T[]> =>
  (value, field) => {
    const items = list(item)(value, field);
    return items.length === size ? items : fail(field, `a list of ${size}`);
  };

const point = tuple(number, 3) as Read<Point3>;
const pair = tuple(number, 2) as Read<[number, number]>;
const outline: Read<[number, number][]> = (value, field) => {
  const points = list(pair)(value, field);
  return points.length >= 3 ? points : fail(field, "an outline of 3 points or more");
};
// A colour may reach a style sheet, so only plain colours pass.
const color: Read<string> = (value, field) =>
  /^#[0-9a-fA-F]{6}$/.test(text(value, field)) ? (value as string) : fail(field, 'a colour such as "#e6785f"');

const box: Read<Header["box"]> = (value, field) => {
  const b = object(value, field);
  const min = point(b.min, `${field}.min`);
  const max = point(b.max, `${field}.max`);
  return min.every((v, i) => v <= max[i]!) ? { min, max } : fail(field, "a box whose min is not above its max");
};

const holder: Read<NonNullable<Header["tool"]["holder"]>> = (value, field) => {
  const h = object(value, field);
  const profile = list(pair)(h.profile, `${field}.profile`);
  if (profile.length === 0) fail(`${field}.profile`, "a list with at least one pair");
  for (let i = 0; i < profile.length; i++) {
    if (profile[i]![1] < 0) fail(`${field}.profile[${i}]`, "a height and a radius from 0 on");
    if (i > 0 && profile[i]![0] < profile[i - 1]![0]) fail(`${field}.profile`, "a list whose heights rise");
  }
  return { stickout: number(h.stickout, `${field}.stickout`), profile };
};

const tool: Read<Header["tool"]> = (value, field) => {
  const t = object(value, field);
  return {
    ball_diameter: positive(t.ball_diameter, `${field}.ball_diameter`),
    flute_length: orNull(positive)(t.flute_length, `${field}.flute_length`),
    shank_diameter: positive(t.shank_diameter, `${field}.shank_diameter`),
    holder: orNull(holder)(t.holder, `${field}.holder`),
  };
};

// Returns the checked header of `json`.
export function readHeader(json: unknown): Header {
  const h = object(json, "scene");
  if (h.version !== 1) {
    throw new SceneError(`This page reads scenes of version 1, and this one has version ${JSON.stringify(h.version)}.`);
  }
  return {
    title: text(h.title, "title"),
    made_by: text(h.made_by, "made_by"),
    outcome: text(h.outcome, "outcome"),
    figures: list(tuple(text, 2) as Read<[string, string]>)(h.figures, "figures"),
    findings: list((value, field) => {
      const f = object(value, field);
      return {
        severity: text(f.severity, `${field}.severity`),
        code: text(f.code, `${field}.code`),
        message: text(f.message, `${field}.message`),
        point: orNull(point)(f.point, `${field}.point`),
      };
    })(h.findings, "findings"),
    box: box(h.box, "box"),
    tolerance: positive(h.tolerance, "tolerance"),
    scallop: orNull(positive)(h.scallop, "scallop"),
    steep_angle: number(h.steep_angle, "steep_angle"),
    tool: tool(h.tool, "tool"),
    stock: orNull((value, field) => {
      const s = object(value, field);
      return {
        outline: outline(s.outline, `${field}.outline`),
        bottom: number(s.bottom, `${field}.bottom`),
        top: number(s.top, `${field}.top`),
      };
    })(h.stock, "stock"),
    clamps: list((value, field) => {
      const c = object(value, field);
      return {
        name: text(c.name, `${field}.name`),
        outline: outline(c.outline, `${field}.outline`),
        top: number(c.top, `${field}.top`),
      };
    })(h.clamps, "clamps"),
    regions: list((value, field) => {
      const r = object(value, field);
      return {
        id: count(r.id, `${field}.id`),
        name: text(r.name, `${field}.name`),
        color: color(r.color, `${field}.color`),
        unreachable: text(r.unreachable, `${field}.unreachable`),
      };
    })(h.regions, "regions"),
    surfaces: list(text)(h.surfaces, "surfaces"),
    borders: list((value, field) => {
      const b = object(value, field);
      return {
        name: text(b.name, `${field}.name`),
        color: color(b.color, `${field}.color`),
        first: count(b.first, `${field}.first`),
        count: count(b.count, `${field}.count`),
      };
    })(h.borders, "borders"),
    passes: list(text)(h.passes, "passes"),
    sections: list((value, field) => {
      const s = object(value, field);
      return { name: text(s.name, `${field}.name`), first_move: count(s.first_move, `${field}.first_move`) };
    })(h.sections, "sections"),
    time_basis: text(h.time_basis, "time_basis"),
  };
}
