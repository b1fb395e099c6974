// Unpacks the data beside the page, which goes on reading meanwhile. The texts come in order, and null is
// their end.
import { Inflater } from "./inflate";
import { SceneError } from "./scene";

export interface ToWorker {
  isPacked?: boolean; // of the first message
  size?: number;
  text: string | null;
}

export type FromWorker = { block: ArrayBuffer } | { fault: string; isScene: boolean };

// The part of a worker's scope that is used.
interface Scope {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage: (message: FromWorker, transfer?: Transferable[]) => void;
}
const scope = self as unknown as Scope;

let inflater: Inflater | null = null;
let work: Promise<void> = Promise.resolve();
let isOver = false;

async function take({ isPacked, size, text }: ToWorker): Promise<void> {
  if (isOver) return;
  try {
    inflater ??= new Inflater(isPacked === true, size ?? 0);
    if (text !== null) return await inflater.push(text);
    const block = await inflater.end();
    scope.postMessage({ block }, [block]);
  } catch (error) {
    isOver = true;
    scope.postMessage({ fault: error instanceof Error ? error.message : String(error), isScene: error instanceof SceneError });
  }
}

scope.onmessage = ({ data }) => {
  work = work.then(() => take(data));
};
