// The clients of the page. They speak Connect to the server that the page came from.
import { createClient } from "@connectrpc/connect";
import { createConnectTransport } from "@connectrpc/connect-web";
import { AnalysisService } from "../gen/patchmill/v1/analysis_service_pb.js";
import { ModelService } from "../gen/patchmill/v1/model_service_pb.js";
import { ToolpathService } from "../gen/patchmill/v1/toolpath_service_pb.js";

const transport = createConnectTransport({ baseUrl: location.origin, useBinaryFormat: true });

export const models = createClient(ModelService, transport);
export const analysis = createClient(AnalysisService, transport);
export const toolpaths = createClient(ToolpathService, transport);

// One call at a time: a new one ends the one before.
export class LatestCall {
  #running: AbortController | null = null;

  get isRunning(): boolean {
    return this.#running !== null;
  }

  cancel(): void {
    this.#running?.abort();
    this.#running = null;
  }

  // Runs `call`. Resolves to null if another call, or cancel, has taken its place.
  async run<T>(call: (signal: AbortSignal) => Promise<T>): Promise<T | null> {
    this.cancel();
    const own = new AbortController();
    this.#running = own;
    try {
      const answer = await call(own.signal);
      return this.#running === own ? answer : null;
    } catch (error) {
      if (this.#running !== own) return null;
      throw error;
    } finally {
      if (this.#running === own) this.#running = null;
    }
  }
}
