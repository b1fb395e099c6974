// The lines of the program, decoded one by one when they are shown.
const longest = 400; // characters of a line that are shown

export class ProgramText {
  readonly #text: Uint8Array;
  readonly #start: Uint32Array; // of each line, and the end of the text
  readonly #decoder = new TextDecoder();

  constructor(text: Uint8Array) {
    this.#text = text;
    let start = new Uint32Array(1024 + Math.ceil(text.length / 24));
    let lines = 0;
    for (let at = 0; at < text.length; at++) {
      if (text[at] !== 10) continue;
      if (++lines + 2 > start.length) {
        const longer = new Uint32Array(2 * start.length);
        longer.set(start);
        start = longer;
      }
      start[lines] = at + 1;
    }
    if (text.length > 0 && text[text.length - 1] !== 10) start[++lines] = text.length;
    this.#start = start.subarray(0, lines + 1);
  }

  get lines(): number {
    return this.#start.length - 1;
  }

  // The text of a line; the first one is 1.
  line(number: number): string {
    if (number < 1 || number > this.lines) return "";
    const start = this.#start[number - 1]!;
    const end = Math.min(this.#start[number]!, start + 4 * longest);
    const text = this.#decoder.decode(this.#text.subarray(start, end)).replace(/\r?\n$/, "");
    return text.length > longest ? `${text.slice(0, longest)}\u2026` : text;
  }
}

// The first move of each line. Lines without a move have the next one, or the last move after all of them.
export function firstMoves(line: Uint32Array, lines: number): Uint32Array {
  const none = 0xffffffff;
  const first = new Uint32Array(lines + 1).fill(none);
  for (let m = line.length - 1; m >= 0; m--) if (line[m]! > 0) first[line[m]!] = m;
  let next = line.length - 1;
  for (let n = lines; n >= 0; n--) {
    if (first[n] === none) first[n] = next;
    else next = first[n]!;
  }
  return first;
}
