// Takes the scene out of the page: the JSON header and the binary block.
import { decodeBase64 } from "./base64";
import { readScene } from "./read_scene";
import { type Scene, SceneError } from "./scene";

async function decompress(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
  // gzip begins with 1f 8b; raw deflate does not.
  const format = bytes[0] === 0x1f && bytes[1] === 0x8b ? "gzip" : "deflate-raw";
  try {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream(format));
    return await new Response(stream).arrayBuffer();
  } catch {
    throw new SceneError("The data are damaged or end early: they cannot be decompressed.");
  }
}

// Reads a scene from the text of its header and the base64 of its block.
export async function readSceneText(headerText: string, dataText: string): Promise<Scene> {
  let json: unknown;
  try {
    json = JSON.parse(headerText);
  } catch {
    throw new SceneError("The header of the scene is damaged: it is not JSON.");
  }
  const encoding = (json as { data_encoding?: unknown } | null)?.data_encoding;
  if (encoding !== undefined && encoding !== "" && encoding !== "gzip" && encoding !== "deflate-raw") {
    throw new SceneError(`The page does not know the data encoding ${JSON.stringify(encoding)}.`);
  }
  const bytes = decodeBase64(dataText);
  if (encoding) return readScene(json, await decompress(bytes));
  const whole = bytes.byteOffset === 0 && bytes.byteLength === bytes.buffer.byteLength;
  return readScene(json, whole ? bytes.buffer : bytes.slice().buffer);
}

// Reads the scene of this page and gives its text back to the browser.
export async function readPage(page: Document): Promise<Scene> {
  const take = (id: string): string => {
    const element = page.getElementById(id);
    if (element === null) throw new SceneError(`The page has no element "${id}".`);
    const text = element.textContent ?? "";
    element.remove();
    return text;
  };
  const header = take("patchmill-scene");
  const data = take("patchmill-data");
  if (/^\s*@\w+@\s*$/.test(header)) throw new SceneError("This page is a template: it holds no scene yet.");
  return readSceneText(header, data);
}
