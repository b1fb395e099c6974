// Takes the scene out of the page: the JSON header and the binary block. The block is unpacked while the
// browser still reads the page, beside it in a worker if there can be one.
import { Inflater } from "./inflate";
import type { FromWorker, ToWorker } from "./inflate_worker";
import workerSource from "./inflate_worker?worker";
import { readScene } from "./read_scene";
import { type Scene, SceneError } from "./scene";

const largeSize = 8 * 2 ** 20; // bytes from which on a worker pays
const mostSigns = 2 ** 22; // of a text that is handed on at once

// What unpacks texts: the inflater itself, or one in a worker.
interface Unpacker {
  push: (text: string) => void | Promise<void>;
  end: () => Promise<ArrayBuffer>;
}

function unpackBeside(isPacked: boolean, size: number): Unpacker {
  const url = URL.createObjectURL(new Blob([workerSource], { type: "text/javascript" }));
  const worker = new Worker(url);
  const answer = new Promise<ArrayBuffer>((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => {
      if ("block" in data) resolve(data.block);
      else reject(data.isScene ? new SceneError(data.fault) : new Error(data.fault));
    };
    worker.onerror = () => reject(new Error("The data cannot be unpacked beside the page."));
  });
  answer.catch(() => {}); // it is said where it is awaited
  const send = (message: ToWorker): void => worker.postMessage(message);
  send({ isPacked, size, text: "" });
  return {
    push: (text) => send({ text }),
    end: async () => {
      send({ text: null });
      try {
        return await answer;
      } finally {
        worker.terminate();
        URL.revokeObjectURL(url);
      }
    },
  };
}

function parse(headerText: string): unknown {
  try {
    return JSON.parse(headerText);
  } catch {
    throw new SceneError("The header of the scene is damaged: it is not JSON.");
  }
}

function isPackedIn(json: unknown): boolean {
  const encoding = (json as { data_encoding?: unknown } | null)?.data_encoding;
  if (encoding !== undefined && encoding !== "" && encoding !== "gzip" && encoding !== "deflate-raw") {
    throw new SceneError(`The page does not know the data encoding ${JSON.stringify(encoding)}.`);
  }
  return encoding === "gzip" || encoding === "deflate-raw";
}

// The bytes that the buffers of the header take. What is no number is left to the checks of the scene.
function sizeOf(json: unknown): number {
  const buffers = (json as { buffers?: unknown } | null)?.buffers;
  const entries = typeof buffers === "object" && buffers !== null ? Object.values(buffers as Record<string, unknown>) : [];
  const ends = entries.map((entry) => {
    const { type, offset, count } = (entry ?? {}) as { type?: unknown; offset?: unknown; count?: unknown };
    return Number(offset) + Number(count) * (type === "u8" ? 1 : 4);
  });
  return ends.reduce((most, end) => (Number.isSafeInteger(end) && end > most ? end : most), 0);
}

// Reads a scene from the text of its header and the base64 of its block.
export async function readSceneText(headerText: string, dataText: string): Promise<Scene> {
  const json = parse(headerText);
  const inflater = new Inflater(isPackedIn(json), sizeOf(json));
  await inflater.push(dataText);
  return readScene(json, await inflater.end());
}

// The text of an element, piece by piece as the browser reads it.
async function* textOf(page: Document, id: string): AsyncGenerator<string> {
  let index = 0; // of the node that is read on
  let offset = 0;
  for (;;) {
    const isWhole = page.readyState !== "loading";
    const nodes = page.getElementById(id)?.childNodes;
    for (;;) {
      const node = nodes?.[index];
      if (!(node instanceof Text)) break;
      if (offset < node.length) {
        const text = node.substringData(offset, mostSigns);
        offset += text.length;
        yield text;
      } else if (nodes!.length > index + 1) [index, offset] = [index + 1, 0];
      else break;
    }
    if (isWhole) {
      if (nodes === undefined) throw new SceneError(`The page has no element "${id}".`);
      return;
    }
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
}

// Reads the scene of this page and gives its text back to the browser.
export async function readPage(page: Document): Promise<Scene> {
  const header = page.getElementById("patchmill-scene");
  if (header === null) throw new SceneError('The page has no element "patchmill-scene".');
  const headerText = header.textContent ?? "";
  if (/^\s*@\w+@\s*$/.test(headerText)) throw new SceneError("This page is a template: it holds no scene yet.");
  const json = parse(headerText);
  const [isPacked, size] = [isPackedIn(json), sizeOf(json)];
  const here = (): Unpacker => new Inflater(isPacked, size);
  const unpack = async (make: () => Unpacker): Promise<ArrayBuffer> => {
    const unpacker = make();
    for await (const text of textOf(page, "patchmill-data")) await unpacker.push(text);
    return unpacker.end();
  };
  const block = await unpack(size < largeSize ? here : () => unpackBeside(isPacked, size)).catch((error: unknown) => {
    if (error instanceof SceneError) throw error;
    return unpack(here); // this browser has no worker for such a page
  });
  for (const id of ["patchmill-scene", "patchmill-data"]) page.getElementById(id)?.remove();
  return readScene(json, block);
}
