// Takes the base64 text of a scene's data piece by piece, and gives the binary block. Memory is bounded by
// what the header states, however much the data would become.
import { decodeBase64 } from "./base64";
import { SceneError } from "./scene";

const atOnce = 512 * 2 ** 20; // bytes that are allocated for what a header states
const slack = 2 ** 20; // bytes that data may have beyond it

class Block {
  readonly #most: number;
  #bytes: Uint8Array<ArrayBuffer>;
  #size = 0;

  // `size`: bytes that the header states.
  constructor(size: number) {
    this.#most = size + slack;
    this.#bytes = new Uint8Array(Math.min(size, atOnce));
  }

  add(piece: Uint8Array): void {
    const size = this.#size + piece.length;
    if (size > this.#most) throw new SceneError(`The data are longer than the header states: they have more than ${this.#most} bytes.`);
    if (size > this.#bytes.length) {
      const longer = new Uint8Array(Math.min(this.#most, Math.max(size, 2 * this.#bytes.length)));
      longer.set(this.#bytes.subarray(0, this.#size));
      this.#bytes = longer;
    }
    this.#bytes.set(piece, this.#size);
    this.#size = size;
  }

  take(): ArrayBuffer {
    const { buffer } = this.#bytes;
    return this.#size === buffer.byteLength ? buffer : buffer.slice(0, this.#size);
  }
}

const spaces = [" ", "\t", "\r", "\n", "\f"];

export class Inflater {
  readonly #isPacked: boolean;
  readonly #block: Block;
  #rest = ""; // signs that are no whole group yet
  #offset = 0; // signs before them
  #isPadded = false; // the text has had its end
  #writer: WritableStreamDefaultWriter<BufferSource> | null = null;
  #reading: Promise<void> = Promise.resolve();

  constructor(isPacked: boolean, size: number) {
    this.#isPacked = isPacked;
    this.#block = new Block(size);
  }

  async #add(text: string): Promise<void> {
    if (text === "") return;
    if (this.#isPadded) throw new SceneError(`The data are damaged: base64 goes on behind its end, at the sign ${this.#offset}.`);
    this.#isPadded = text.endsWith("=");
    const bytes = decodeBase64(text, undefined, this.#offset);
    this.#offset += text.length;
    if (!this.#isPacked) this.#block.add(bytes);
    else {
      this.#writer ??= this.#open(bytes);
      await Promise.race([this.#writer.write(bytes), this.#reading]); // what was read may be too much
    }
  }

  // gzip begins with 1f 8b; raw deflate does not.
  #open(first: Uint8Array): WritableStreamDefaultWriter<BufferSource> {
    const stream = new DecompressionStream(first[0] === 0x1f && first[1] === 0x8b ? "gzip" : "deflate-raw");
    this.#reading = this.#read(stream.readable.getReader());
    this.#reading.catch(() => {}); // it is said where it is awaited
    return stream.writable.getWriter();
  }

  async #read(reader: ReadableStreamDefaultReader<Uint8Array>): Promise<void> {
    for (;;) {
      const { value, done } = await reader.read();
      if (done) return;
      try {
        this.#block.add(value);
      } catch (error) {
        void reader.cancel();
        throw error;
      }
    }
  }

  async push(text: string): Promise<void> {
    const signs = spaces.some((space) => text.includes(space)) ? text.replace(/[ \t\r\n\f]+/g, "") : text;
    const all = this.#rest + signs;
    const whole = all.length - (all.length % 4);
    this.#rest = all.slice(whole);
    await this.#guard(() => this.#add(all.slice(0, whole)));
  }

  async end(): Promise<ArrayBuffer> {
    await this.#guard(async () => {
      await this.#add(this.#rest);
      if (this.#isPacked && this.#writer === null) throw new SceneError("The data end early: there are none.");
      await this.#writer?.close();
      await this.#reading;
    });
    return this.#block.take();
  }

  async #guard(work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof SceneError) throw error;
      // A stream that fails does so at both ends. What its reading found wrong is nearer to the cause.
      const cause = await this.#reading.then(() => error, (e: unknown) => e);
      if (cause instanceof SceneError) throw cause;
      throw new SceneError("The data are damaged or end early: they cannot be decompressed.");
    }
  }
}
