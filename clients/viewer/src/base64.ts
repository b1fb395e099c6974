// Decodes base64 into bytes. White space is skipped; anything else that is no base64 gives a SceneError.
import { SceneError } from "./scene";

const bad = 64;
const skip = 65;

function makeTable(): Uint8Array {
  const table = new Uint8Array(128).fill(bad);
  const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (let i = 0; i < 64; i++) table[digits.charCodeAt(i)] = i;
  for (const space of " \t\r\n\f") table[space.charCodeAt(0)] = skip;
  return table;
}

function decodeByTable(text: string, offset: number): Uint8Array<ArrayBuffer> {
  const table = makeTable();
  let end = text.length;
  while (end > 0 && (text[end - 1] === "=" || table[text.charCodeAt(end - 1)] === skip)) end--;
  const bytes = new Uint8Array(Math.ceil((end * 3) / 4));
  let at = 0;
  let to = 0;
  // Four digits at a time, as long as they are digits.
  while (at + 4 <= end) {
    const a = table[text.charCodeAt(at)]!;
    const b = table[text.charCodeAt(at + 1)]!;
    const c = table[text.charCodeAt(at + 2)]!;
    const d = table[text.charCodeAt(at + 3)]!;
    if (!(a < 64 && b < 64 && c < 64 && d < 64)) break;
    const v = (a << 18) | (b << 12) | (c << 6) | d;
    bytes[to] = v >> 16;
    bytes[to + 1] = v >> 8;
    bytes[to + 2] = v;
    to += 3;
    at += 4;
  }
  let bits = 0;
  let size = 0;
  for (; at < end; at++) {
    const digit = table[text.charCodeAt(at)] ?? bad;
    if (digit === skip) continue;
    if (digit === bad) throw new SceneError(`The data are damaged: the sign ${offset + at} is no base64.`);
    bits = ((bits << 6) | digit) & 0xffff;
    size += 6;
    if (size >= 8) {
      size -= 8;
      bytes[to++] = bits >> size;
    }
  }
  if (size === 6) throw new SceneError("The data end early: a base64 group has one digit.");
  return bytes.subarray(0, to);
}

type NativeDecoder = { fromBase64?: (text: string) => Uint8Array<ArrayBuffer> };

// Browsers that have a decoder of their own are three times as fast as the table. `offset`: signs before this
// text, for messages.
export function decodeBase64(text: string, native = (Uint8Array as NativeDecoder).fromBase64, offset = 0): Uint8Array<ArrayBuffer> {
  if (native === undefined) return decodeByTable(text, offset);
  try {
    return native.call(Uint8Array, text);
  } catch {
    return decodeByTable(text, offset); // it says what is wrong
  }
}
