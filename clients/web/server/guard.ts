// Decides whether a request may come in at all. The page is for its own origin alone: other sites, and names that an attacker
// points at this machine (DNS rebinding), are refused before anything is read.
import type { IncomingHttpHeaders } from "node:http";
import { isIP } from "node:net";

export interface Refusal {
  status: number;
  message: string;
}

// The host of "name:port" or "[address]:port".
function hostOf(authority: string): string | null {
  const match = /^(?:\[([0-9a-fA-F:.]+)\]|([A-Za-z0-9._-]+))(?::\d{1,5})?$/.exec(authority);
  return match?.[1] ?? match?.[2]?.toLowerCase() ?? null;
}

export interface Asked {
  method: string;
  path: string; // without the query
  headers: IncomingHttpHeaders;
}

export function refusalOf({ method, path, headers }: Asked, names: readonly string[]): Refusal | null {
  const host = hostOf(headers.host ?? "");
  // Rebinding needs a name; an address in numbers cannot be pointed elsewhere.
  if (host === null || (isIP(host) === 0 && host !== "localhost" && !names.includes(host))) {
    return { status: 421, message: "This server is not asked by that name. Start it with --name HOST to allow the name." };
  }
  const { origin } = headers;
  const isOwnOrigin = origin === undefined || origin === `http://${headers.host}` || origin === `https://${headers.host}`;
  const site = headers["sec-fetch-site"];
  // A link from elsewhere may open the page. It carries nothing but the address.
  const isLink = method === "GET" && path === "/" && headers["sec-fetch-mode"] === "navigate" && headers["sec-fetch-dest"] === "document";
  const isOwnSite = site === undefined || site === "same-origin" || (site === "none" && method !== "POST");
  if (!isOwnOrigin || !(isOwnSite || isLink)) return { status: 403, message: "Requests from other sites are refused." };
  if (method !== "GET" && method !== "HEAD" && method !== "POST") return { status: 405, message: "Only GET, HEAD and POST are known." };
  return null;
}
