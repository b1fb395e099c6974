// The server: its own files, and the calls that it hands on. It holds nothing but running calls.
import { readFileSync } from "node:fs";
import { createServer, type IncomingMessage, type Server, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import { connectNodeAdapter, createGrpcTransport } from "@connectrpc/connect-node";
import { type PageFile, readFiles, safeHeaders } from "./files";
import { forward } from "./forward";
import { refusalOf } from "./guard";
import type { Options } from "./options";

export const maxRequestBytes = 64 * 2 ** 20; // that of patchmilld
const maxAnswerBytes = 64 * 2 ** 20; // of one message
const maxBytesAtOnce = 256 * 2 ** 20; // of the requests of all running calls
const maxConnections = 512;

export interface RunningServer {
  url: string;
  server: Server;
  close: () => Promise<void>;
}

function answer(response: ServerResponse, status: number, message: string, code: string): void {
  // The body is an error as Connect writes it, so that the page can show it.
  const body = JSON.stringify({ code, message });
  response.writeHead(status, { ...safeHeaders, "Content-Type": "application/json", "Content-Length": Buffer.byteLength(body), Connection: "close" });
  response.end(body);
}

function sendFile(request: IncomingMessage, response: ServerResponse, file: PageFile): void {
  if (request.headers["if-none-match"] === file.headers.ETag) {
    response.writeHead(304, file.headers).end();
    return;
  }
  response.writeHead(200, { ...file.headers, "Content-Length": file.body.length });
  response.end(request.method === "HEAD" ? undefined : file.body);
}

export async function startServer(options: Options, publicFolder: string): Promise<RunningServer> {
  const files = readFiles(publicFolder);
  const backend = `${options.backend.host.includes(":") ? `[${options.backend.host}]` : options.backend.host}:${options.backend.port}`;
  const isTls = options.backendCa !== null;
  const transport = createGrpcTransport({
    baseUrl: `${isTls ? "https" : "http"}://${backend}`,
    ...(options.backendCa === null ? {} : { nodeOptions: { ca: readFileSync(options.backendCa) } }),
    readMaxBytes: maxAnswerBytes + 1024,
    writeMaxBytes: maxRequestBytes,
    acceptCompression: [],
    // patchmilld closes a connection that has no call for a minute.
    idleConnectionTimeoutMs: 30_000,
  });
  const shutdown = new AbortController();
  const handleCall = connectNodeAdapter({
    routes: (router) => forward(router, transport, backend),
    grpc: false,
    grpcWeb: false,
    requireConnectProtocolHeader: true,
    acceptCompression: [], // a small body may unpack to any size
    readMaxBytes: maxRequestBytes,
    writeMaxBytes: maxAnswerBytes + 1024,
    shutdownSignal: shutdown.signal,
    fallback: (_request, response) => answer(response as ServerResponse, 404, "There is no such method.", "unimplemented"),
  });
  let calls = 0;
  let bytes = 0;

  const onCall = (request: IncomingMessage, response: ServerResponse): void => {
    const type = request.headers["content-type"] ?? "";
    if (!/^application\/(connect\+)?proto$/.test(type)) {
      answer(response, 415, "Messages must be binary: application/proto or application/connect+proto.", "unimplemented");
      return;
    }
    const stated = request.headers["content-length"];
    const size = stated === undefined ? maxRequestBytes : Number(stated);
    // A message in a stream has five bytes before it.
    if (size > maxRequestBytes + 5) {
      answer(response, 413, `The request has ${(size / 2 ** 20).toFixed(1)} MiB; the limit is 64 MiB.`, "resource_exhausted");
      return;
    }
    if (calls >= options.maxCalls || bytes + size > maxBytesAtOnce) {
      answer(response, 429, "The server is busy with as many calls as it may have at once. Try again in a moment.", "resource_exhausted");
      return;
    }
    calls++;
    bytes += size;
    response.once("close", () => {
      calls--;
      bytes -= size;
    });
    for (const [name, value] of Object.entries(safeHeaders)) response.setHeader(name, value);
    response.setHeader("Cache-Control", "no-store");
    handleCall(request, response);
  };

  const server = createServer({ maxHeaderSize: 16 * 1024, requestTimeout: 300_000, headersTimeout: 20_000 }, (request, response) => {
    const path = (request.url ?? "/").split("?", 1)[0]!;
    const refusal = refusalOf({ method: request.method ?? "", path, headers: request.headers }, options.names);
    if (refusal !== null) {
      answer(response, refusal.status, refusal.message, "permission_denied");
      return;
    }
    if (request.method === "POST") {
      onCall(request, response);
      return;
    }
    const file = files.get(path);
    if (file === undefined) answer(response, 404, "There is no such file.", "not_found");
    else sendFile(request, response, file);
  });
  server.maxConnections = maxConnections;
  server.keepAliveTimeout = 30_000;
  await new Promise<void>((resolve, reject) => {
    server.once("error", reject);
    server.listen(options.listen.port, options.listen.host, resolve);
  });
  const { address, family, port } = server.address() as AddressInfo;
  return {
    url: `http://${family === "IPv6" ? `[${address}]` : address}:${port}/`,
    server,
    close: async () => {
      shutdown.abort();
      const closed = new Promise<void>((resolve) => server.close(() => resolve()));
      server.closeIdleConnections();
      setTimeout(() => server.closeAllConnections(), 1000).unref();
      await closed;
    },
  };
}
