// Reads the texts of settings. A text that cannot be read gives a SettingError, which names the setting.
import { type Choice, settingOf } from "./settings";

export class SettingError extends Error {
  readonly setting: string;

  constructor(setting: string, message: string) {
    super(message);
    this.setting = setting;
  }
}

function readNumber(text: string): number | null {
  if (!/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text)) return null;
  const value = Number(text);
  return Number.isFinite(value) ? value : null;
}

// A number, or undefined if it is not stated.
export function numberOf(choice: Choice, name: string): number | undefined {
  const text = choice.get(name);
  if (text === "") return undefined;
  const value = readNumber(text);
  if (value === null) {
    const comma = text.includes(",") ? " Write a decimal point." : "";
    throw new SettingError(name, `"${text.slice(0, 40)}" is no number.${comma}`);
  }
  if (settingOf(name).kind === "whole" && !Number.isInteger(value)) throw new SettingError(name, `${text} is no whole number.`);
  return value;
}

// A number that has a default.
export function mustNumber(choice: Choice, name: string): number {
  return numberOf(choice, name) ?? Number(settingOf(name).default);
}

// What a word stands for. Words that the table does not have are an error, also those that every object has.
export function wordOf<T>(choice: Choice, name: string, table: Readonly<Record<string, T>>): T {
  const word = choice.get(name);
  const meaning = Object.hasOwn(table, word) ? table[word] : undefined;
  if (meaning === undefined) throw new SettingError(name, `"${word.slice(0, 40)}" must be one of ${Object.keys(table).join(", ")}.`);
  return meaning;
}

export const flagOf = (choice: Choice, name: string): boolean => choice.isSet(name);

// Numbers apart by commas.
export function numbersOf(text: string, counts: readonly number[], name: string, wanted: string): number[] {
  const numbers = text.split(",").map((part) => readNumber(part.trim()));
  if (!counts.includes(numbers.length) || numbers.includes(null)) throw new SettingError(name, `"${text.slice(0, 60)}" must be ${wanted}.`);
  return numbers as number[];
}

export const pointOf = ([xMm = 0, yMm = 0, zMm = 0]: readonly number[]): { xMm: number; yMm: number; zMm: number } => ({ xMm, yMm, zMm });

// "X,Y X,Y X,Y" as x y x y x y.
export function ringOf(text: string, name: string): number[] {
  const points = text.trim().split(/\s+/).filter((p) => p !== "");
  const xy = points.flatMap((p) => numbersOf(p, [2], name, "points X,Y, apart by spaces"));
  if (xy.length < 6) throw new SettingError(name, `An outline has at least 3 points, and "${text.slice(0, 40)}" has ${xy.length / 2}.`);
  return xy;
}

// The longest beginning of a text that takes at most this many bytes of UTF-8. Lone surrogates become "?".
export function wireText(text: string, most: number): string {
  const bytes = new TextEncoder().encode(text.replace(/[\uD800-\uDBFF](?![\uDC00-\uDFFF])|(?<![\uD800-\uDBFF])[\uDC00-\uDFFF]/g, "?"));
  let end = Math.min(bytes.length, most);
  while (end > 0 && end < bytes.length && (bytes[end]! & 0xc0) === 0x80) end--;
  return new TextDecoder().decode(bytes.subarray(0, end));
}
