// What went wrong behind the server, for a user of the page.
import { Code, ConnectError } from "@connectrpc/connect";

// Errors of the network and of HTTP/2 have a code of the system; those of patchmilld have none.
function isOfNetwork(error: unknown): boolean {
  for (let e: unknown = error, depth = 0; e instanceof Error && depth < 5; e = e.cause, depth++) {
    const code = (e as { code?: unknown }).code;
    if (typeof code === "string" && /^(ECONN|ENOTFOUND|EAI_|EHOST|ENET|ETIMEDOUT|EPIPE|ERR_HTTP2|ERR_SSL|ERR_TLS|CERT_|DEPTH_|SELF_|UNABLE_)/.test(code)) return true;
  }
  return false;
}

// Code, message and details of the answer stay; its headers are those of gRPC and stay behind.
export function clearError(error: unknown, backend: string): ConnectError {
  const from = ConnectError.from(error);
  const isLost = from.code !== Code.Canceled && from.code !== Code.DeadlineExceeded && isOfNetwork(error);
  const message = isLost
    ? `patchmilld does not answer at ${backend}. Check that it runs there: scripts/web.sh starts both. (${from.rawMessage})`
    : from.rawMessage;
  const clear = new ConnectError(message, isLost ? Code.Unavailable : from.code, undefined, undefined, error);
  clear.details = from.details;
  return clear;
}
