// The binary block of a scene, and the table of what lies where in it (clients/cli/scene_buffers.cc).
type Values = Float32Array | Uint32Array | Int32Array | Uint8Array;

const typeOf = (values: Values): string =>
  values instanceof Float32Array ? "f32" : values instanceof Uint32Array ? "u32" : values instanceof Int32Array ? "i32" : "u8";

export class SceneBuffers {
  readonly table: Record<string, { type: string; offset: number; count: number }> = {};
  readonly #parts: Values[] = [];
  #size = 0;

  add(name: string, values: Values): void {
    this.table[name] = { type: typeOf(values), offset: this.#size, count: values.length };
    this.#parts.push(values);
    this.#size += Math.ceil(values.byteLength / 4) * 4;
  }

  block(): ArrayBuffer {
    const bytes = new Uint8Array(this.#size);
    let at = 0;
    for (const { buffer, byteOffset, byteLength } of this.#parts) {
      bytes.set(new Uint8Array(buffer, byteOffset, byteLength), at);
      at += Math.ceil(byteLength / 4) * 4;
    }
    return bytes.buffer;
  }
}

// Puts the lists of all blocks behind each other.
export function joined<B, A extends Values>(Type: new (size: number) => A, blocks: readonly B[], listOf: (block: B) => readonly number[]): A {
  const all = new Type(blocks.reduce((sum, b) => sum + listOf(b).length, 0));
  let at = 0;
  for (const block of blocks) {
    const list = listOf(block);
    for (let i = 0; i < list.length; i++) all[at++] = list[i]!;
  }
  return all;
}
