// The command line of the server.
import { isIP } from "node:net";

export interface Options {
  listen: { host: string; port: number };
  backend: { host: string; port: number };
  backendCa: string | null; // file of a certificate: the backend is reached over TLS
  names: string[]; // host names, in lower case, that the page may be asked for by
  maxCalls: number;
  help: boolean;
}

export const help = `usage: server.mjs [options]
Serves Patchmill's web page. It speaks Connect to the browser and gRPC to patchmilld.

  --listen HOST:PORT   address of the page; default 127.0.0.1:8080, this machine only; port 0: any free one
  --backend HOST:PORT  address of patchmilld; default 127.0.0.1:50051
  --backend-ca FILE    patchmilld is reached over TLS; its certificate must be of this authority (PEM)
  --name HOST          a name that the page may be asked for by, besides localhost and numeric addresses; may be repeated
  --max-calls N        calls at once, 1 to 1000; more are refused; default 32
  --help               this text

The page has no log-in and no TLS of its own. Beyond this machine, put a proxy in front that has both.`;

export class UsageError extends Error {}

function address(text: string, option: string): { host: string; port: number } {
  const match = /^(?:\[([0-9a-fA-F:.]+)\]|([^:[\]]+)):(\d{1,5})$/.exec(text);
  const host = match?.[1] ?? match?.[2];
  const port = Number(match?.[3]);
  if (host === undefined || port > 65535) throw new UsageError(`${option} ${text}; it must be HOST:PORT.`);
  return { host, port };
}

export const isLoopback = (host: string): boolean => host === "localhost" || host === "::1" || /^127(\.\d{1,3}){3}$/.test(host);

export function readOptions(args: readonly string[]): Options {
  const options: Options = {
    listen: { host: "127.0.0.1", port: 8080 },
    backend: { host: "127.0.0.1", port: 50051 },
    backendCa: null,
    names: [],
    maxCalls: 32,
    help: false,
  };
  for (let i = 0; i < args.length; i++) {
    const [name = "", inline] = args[i]!.split(/=(.*)/s, 2);
    if (name === "--help" || name === "-h") {
      options.help = true;
      continue;
    }
    const value = (): string => {
      const text = inline ?? args[++i];
      if (text === undefined || text === "") throw new UsageError(`${name} needs a value.`);
      return text;
    };
    if (name === "--listen") options.listen = address(value(), name);
    else if (name === "--backend") options.backend = address(value(), name);
    else if (name === "--backend-ca") options.backendCa = value();
    else if (name === "--name") options.names.push(value().toLowerCase());
    else if (name === "--max-calls") {
      const text = value();
      options.maxCalls = Number(text);
      if (!/^\d+$/.test(text) || options.maxCalls < 1 || options.maxCalls > 1000) {
        throw new UsageError(`--max-calls ${text}; it must be a whole number from 1 to 1000.`);
      }
    } else throw new UsageError(`${args[i]} is no option; --help lists them.`);
  }
  const { host } = options.listen;
  if (isIP(host) === 0) options.names.push(host.toLowerCase());
  return options;
}
