// The server between browser and patchmilld: what it hands on, and what it refuses.
import assert from "node:assert/strict";
import { createServer } from "node:http2";
import { request as httpRequest } from "node:http";
import { connect as netConnect } from "node:net";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { Code, ConnectError, createClient } from "@connectrpc/connect";
import { connectNodeAdapter, createConnectTransport } from "@connectrpc/connect-node";
import { AnalysisService } from "../gen/patchmill/v1/analysis_service_pb.js";
import { ModelService } from "../gen/patchmill/v1/model_service_pb.js";
import { ErrorInfoSchema } from "../gen/patchmill/v1/status_pb.js";
import { ToolpathService } from "../gen/patchmill/v1/toolpath_service_pb.js";
import { example, freePort, needBuild, startBackend, startWeb } from "./support.mjs";

const clientOf = (service, url) => createClient(service, createConnectTransport({ baseUrl: url.replace(/\/$/, ""), httpVersion: "1.1", useBinaryFormat: true }));
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

// A request as bytes of HTTP, without what a client library adds or refuses.
function raw(url, { method = "GET", path = "/", headers = {}, body } = {}) {
  const { hostname, port } = new URL(url);
  return new Promise((resolve, reject) => {
    const request = httpRequest({ hostname, port, method, path, headers, agent: false }, (response) => {
      const parts = [];
      response.on("data", (part) => parts.push(part));
      response.on("end", () => resolve({ status: response.statusCode, headers: response.headers, text: Buffer.concat(parts).toString() }));
    });
    request.on("error", reject);
    request.end(body);
  });
}

// A backend that behaves as a test wants it, and notes what reaches it.
async function startFake(toolpath) {
  const seen = [];
  const server = createServer(connectNodeAdapter({ routes: (router) => router.service(ToolpathService, toolpath(seen)) }));
  const port = await freePort();
  await new Promise((resolve) => server.listen(port, "127.0.0.1", resolve));
  const sessions = new Set();
  server.on("session", (session) => sessions.add(session));
  return {
    seen,
    port,
    sessions,
    stop: () => {
      for (const session of sessions) session.destroy();
      server.close();
    },
  };
}

let backend;
let web;
before(async () => {
  needBuild();
  backend = await startBackend();
  web = await startWeb(backend.port);
});
after(async () => {
  await web?.stop();
  await backend?.stop();
});

const post = (path, headers, body) => raw(web.url, { method: "POST", path, headers, body });
const listPosts = "/patchmill.v1.ToolpathService/ListPosts";
const good = { "content-type": "application/proto", "connect-protocol-version": "1" };

test("methods of all three services answer", async () => {
  const { posts } = await clientOf(ToolpathService, web.url).listPosts({});
  assert.ok(posts.some((p) => p.name === "linuxcnc"));
  const content = new Uint8Array(await readFile(example("bonnet.json")));
  const source = { source: { case: "file", value: { content } } };
  const check = await clientOf(ModelService, web.url).checkModel({ source, setup: {} });
  assert.equal(check.patchCount, 9);
  const tool = { number: 1, cutter: { case: "ballEnd", value: { diameterMm: 6 } }, spindleRpm: 1e4, feedMmPerMin: 1e3, plungeFeedMmPerMin: 300 };
  const job = { source, setup: {}, operations: [{ tool, scallopMm: 0.1, toleranceMm: 0.05 }] };
  const { regions } = await clientOf(AnalysisService, web.url).splitRegions({ job });
  assert.ok(regions.regions.length > 0);
});

test("a method that takes a stream is not there, and the others of its service are", async () => {
  const path = "/patchmill.v1.ModelService/";
  const call = (method) => fetch(`${web.url.replace(/\/$/, "")}${path}${method}`, { method: "POST", headers: { "content-type": "application/proto" }, body: new Uint8Array() });
  assert.ok([404, 415].includes((await call("UploadModel")).status));
  assert.ok(![404, 415].includes((await call("CheckModel")).status));
});

test("an error keeps its code, its message and its fields", async () => {
  const content = new Uint8Array(await readFile(example("bonnet.json")));
  const job = { source: { source: { case: "file", value: { content } } }, operations: [{ scallopMm: -1, toleranceMm: 0.01 }] };
  const call = clientOf(AnalysisService, web.url).splitRegions({ job });
  await assert.rejects(call, (error) => {
    assert.ok(error instanceof ConnectError);
    assert.equal(error.code, Code.InvalidArgument);
    const [info] = error.findDetails(ErrorInfoSchema);
    assert.equal(info.reason, "INVALID_FIELDS");
    assert.ok(info.fieldViolations.some((v) => v.field === "job.operations[0].scallop_mm" && v.description.includes("-1")));
    assert.equal(error.metadata.get("grpc-status"), null);
    return true;
  });
});

test("token and deadline are passed on; nothing else of the browser is", async () => {
  const fake = await startFake((seen) => ({
    listPosts: (_request, context) => {
      seen.push({ token: context.requestHeader.get("authorization"), cookie: context.requestHeader.get("cookie"), ms: context.timeoutMs() });
      return { posts: [] };
    },
  }));
  const own = await startWeb(fake.port);
  await clientOf(ToolpathService, own.url).listPosts({}, { headers: { authorization: "Bearer t0k", cookie: "a=b" }, timeoutMs: 5000 });
  assert.equal(fake.seen[0].token, "Bearer t0k");
  assert.equal(fake.seen[0].cookie, null);
  assert.ok(fake.seen[0].ms > 4000 && fake.seen[0].ms <= 5000);
  await own.stop();
  fake.stop();
});

test("answers of a stream come as they are made, and a cancel reaches the backend within 200 ms", async () => {
  let ended = 0;
  const fake = await startFake(() => ({
    async *generateProgram(_request, context) {
      context.signal.addEventListener("abort", () => (ended = performance.now()));
      yield { event: { case: "progress", value: { stage: "first", fraction: 0.5 } } };
      while (!context.signal.aborted) await wait(5);
    },
  }));
  const own = await startWeb(fake.port);
  const stop = new AbortController();
  let cancelled = 0;
  await assert.rejects(async () => {
    for await (const { event } of clientOf(ToolpathService, own.url).generateProgram({}, { signal: stop.signal })) {
      assert.equal(event.value.stage, "first");
      cancelled = performance.now();
      stop.abort();
    }
  });
  for (let i = 0; i < 100 && ended === 0; i++) await wait(10);
  assert.ok(ended > 0, "the backend never heard of the cancel");
  assert.ok(ended - cancelled < 200, `the backend heard of it after ${ended - cancelled} ms`);
  await own.stop();
  fake.stop();
});

test("a deadline ends a call at the backend", async () => {
  let aborted = false;
  const fake = await startFake(() => ({
    async *generateProgram(_request, context) {
      context.signal.addEventListener("abort", () => (aborted = true));
      while (!context.signal.aborted) await wait(5);
    },
  }));
  const own = await startWeb(fake.port);
  const start = performance.now();
  const drain = async () => {
    for await (const _ of clientOf(ToolpathService, own.url).generateProgram({}, { timeoutMs: 300 }));
  };
  await assert.rejects(drain, (error) => error.code === Code.DeadlineExceeded);
  assert.ok(performance.now() - start < 1500);
  for (let i = 0; i < 20 && !aborted; i++) await wait(10);
  assert.ok(aborted);
  await own.stop();
  fake.stop();
});

test("a backend that ends in the middle of a stream is an error", async () => {
  const fake = await startFake(() => ({
    async *generateProgram() {
      yield { event: { case: "progress", value: { stage: "first", fraction: 0.5 } } };
      await wait(20);
      for (const session of fake.sessions) session.destroy();
      await wait(1000);
    },
  }));
  const own = await startWeb(fake.port);
  const drain = async () => {
    for await (const _ of clientOf(ToolpathService, own.url).generateProgram({}));
  };
  await assert.rejects(drain, (error) => error instanceof ConnectError && error.code !== Code.Ok);
  await own.stop();
  fake.stop();
});

test("a backend that is not there is named, and the server goes on when it comes", async () => {
  const port = await freePort();
  const own = await startWeb(port);
  const client = clientOf(ToolpathService, own.url);
  await assert.rejects(client.listPosts({}), (error) => {
    assert.equal(error.code, Code.Unavailable);
    assert.match(error.rawMessage, new RegExp(`patchmilld does not answer at 127\\.0\\.0\\.1:${port}`));
    return true;
  });
  const late = await startBackend(port);
  assert.ok((await client.listPosts({})).posts.length > 0);
  await late.stop();
  await own.stop();
});

test("requests of other sites are refused", async () => {
  const own = new URL(web.url).host;
  const refused = [
    { origin: "https://evil.example" },
    { origin: "null" },
    { origin: `http://${own}`, "sec-fetch-site": "cross-site" },
    { origin: `http://${own}`, "sec-fetch-site": "same-site" },
    { "sec-fetch-site": "none" },
  ];
  for (const headers of refused) assert.equal((await post(listPosts, { ...good, ...headers }, "")).status, 403, JSON.stringify(headers));
  assert.equal((await post(listPosts, { ...good, origin: `http://${own}`, "sec-fetch-site": "same-origin" }, "")).status, 200);
  // A page of another site may link here, but it may not embed or read what is here.
  const cross = { "sec-fetch-site": "cross-site" };
  assert.equal((await raw(web.url, { headers: { ...cross, "sec-fetch-mode": "navigate", "sec-fetch-dest": "document" } })).status, 200);
  assert.equal((await raw(web.url, { headers: { ...cross, "sec-fetch-mode": "navigate", "sec-fetch-dest": "iframe" } })).status, 403);
  assert.equal((await raw(web.url, { path: "/page.js", headers: { ...cross, "sec-fetch-mode": "no-cors", "sec-fetch-dest": "script" } })).status, 403);
  assert.equal((await raw(web.url, { method: "OPTIONS", path: listPosts })).status, 405);
});

test("a name that is pointed at this machine is refused", async () => {
  const { port } = new URL(web.url);
  for (const host of ["evil.example", `evil.example:${port}`, "127.0.0.1.evil.example", "localhost@evil", "a b"]) {
    assert.equal((await raw(web.url, { headers: { host } })).status, 421, host);
  }
  for (const host of [`127.0.0.1:${port}`, `localhost:${port}`, `[::1]:${port}`]) assert.equal((await raw(web.url, { headers: { host } })).status, 200, host);
  const named = await startWeb(backend.port, "--name", "mill.shop.example");
  assert.equal((await raw(named.url, { headers: { host: "mill.shop.example" } })).status, 200);
  assert.equal((await raw(named.url, { headers: { host: "other.example" } })).status, 421);
  await named.stop();
});

test("only binary messages of the protocol come in, and no form of another page can send them", async () => {
  for (const type of ["application/json", "text/plain", "multipart/form-data; boundary=x", "application/x-www-form-urlencoded", "application/grpc"]) {
    assert.equal((await post(listPosts, { ...good, "content-type": type }, "{}")).status, 415, type);
  }
  assert.equal((await post(listPosts, { "content-type": "application/proto" }, "")).status, 400);
  assert.equal((await post("/patchmill.v1.ToolpathService/Nothing", good, "")).status, 404);
  assert.equal((await post("/grpc.health.v1.Health/Check", good, "")).status, 404);
});

test("a body above the limit is refused before it comes, and while it comes", async () => {
  const announced = await raw(web.url, { method: "POST", path: "/patchmill.v1.ModelService/CheckModel", headers: { ...good, "content-length": 65 * 2 ** 20 } }).catch((error) => error);
  assert.equal(announced.status, 413);
  assert.match(announced.text, /65\.0 MiB; the limit is 64 MiB/);
  // Without a length: it is counted while it is read.
  const { hostname, port } = new URL(web.url);
  const answer = await new Promise((resolve) => {
    const request = httpRequest({ hostname, port, method: "POST", path: "/patchmill.v1.ModelService/CheckModel", headers: { ...good, "transfer-encoding": "chunked" }, agent: false }, (response) => {
      let text = "";
      response.on("data", (part) => (text += part));
      response.on("end", () => resolve({ status: response.statusCode, text }));
    });
    request.on("error", (error) => resolve({ error }));
    const part = Buffer.alloc(2 ** 20);
    let sent = 0;
    const send = () => {
      while (sent++ < 66) if (!request.write(part)) return void request.once("drain", send);
      request.end();
    };
    send();
  });
  assert.ok(answer.error !== undefined || (answer.status === 429 && /resource_exhausted/.test(answer.text)), JSON.stringify(answer));
  assert.ok((await clientOf(ToolpathService, web.url).listPosts({})).posts.length > 0, "the server lives on");
});

test("more calls at once than allowed are refused", async () => {
  const fake = await startFake(() => ({
    async *generateProgram(_request, context) {
      yield { event: { case: "progress", value: { stage: "first", fraction: 0 } } };
      while (!context.signal.aborted) await wait(5);
    },
  }));
  const own = await startWeb(fake.port, "--max-calls", "1");
  const stop = new AbortController();
  const running = clientOf(ToolpathService, own.url).generateProgram({}, { signal: stop.signal })[Symbol.asyncIterator]();
  await running.next();
  await assert.rejects(clientOf(ToolpathService, own.url).listPosts({}), (error) => error.code === Code.ResourceExhausted && /busy/.test(error.rawMessage));
  stop.abort();
  await running.next().catch(() => {});
  await own.stop();
  fake.stop();
});

test("files are those of the page alone, with the headers that keep them in", async () => {
  for (const path of ["/../package.json", "/..%2fserver.mjs", "/%2e%2e/server.mjs", "//etc/passwd", "/server.mjs", "/index.html/..", "/.", "/page.js/"]) {
    assert.equal((await raw(web.url, { path })).status, 404, path);
  }
  const { headers } = await raw(web.url, { path: "/" });
  const policy = headers["content-security-policy"];
  for (const rule of ["default-src 'none'", "script-src 'self'", "connect-src 'self'", "frame-ancestors 'none'", "base-uri 'none'", "form-action 'none'"]) assert.ok(policy.includes(rule), rule);
  assert.ok(!policy.includes("unsafe"));
  assert.equal(headers["x-content-type-options"], "nosniff");
  assert.equal(headers["access-control-allow-origin"], undefined);
  assert.ok((await raw(web.url, { path: "/frame.html" })).headers["content-security-policy"].includes("frame-ancestors 'self'"));
  assert.equal((await raw(web.url, { path: "/page.js", headers: { "if-none-match": (await raw(web.url, { path: "/page.js" })).headers.etag } })).status, 304);
});

test("damaged bytes of HTTP and of messages do not end the server", async () => {
  const { port } = new URL(web.url);
  await new Promise((resolve) => {
    const socket = netConnect(Number(port), "127.0.0.1", () => socket.end("GET / HTTP/9.9\r\n\u0000\r\n\r\n"));
    socket.on("close", resolve).on("error", resolve).resume();
  });
  const bad = await post("/patchmill.v1.ModelService/CheckModel", good, Buffer.from([0xff, 0xff, 0xff, 0xff, 0x0f]));
  assert.ok(bad.status >= 400 && /"code"/.test(bad.text));
  const stream = await post("/patchmill.v1.ToolpathService/GenerateProgram", { ...good, "content-type": "application/connect+proto" }, Buffer.from([0, 0, 0, 0, 9, 1]));
  assert.ok(stream.status === 200 && /error/.test(stream.text));
  assert.equal((await raw(web.url)).status, 200);
});

test("wrong options end the server with status 2", async () => {
  for (const args of [["--listen", "nowhere"], ["--max-calls", "0"], ["--what"], ["--backend"]]) {
    const own = await startWeb(backend.port, ...args);
    assert.equal(own.url, null);
    assert.equal(await own.ended, 2);
  }
});
