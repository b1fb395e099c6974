// The files of the page. They are read once, into a table by name, so no path of a request reaches the disk.
import { readdirSync, readFileSync } from "node:fs";
import { createHash } from "node:crypto";
import { join } from "node:path";

export interface PageFile {
  body: Buffer;
  headers: Record<string, string>;
}

const types: Record<string, string> = {
  html: "text/html; charset=utf-8",
  css: "text/css; charset=utf-8",
  js: "text/javascript; charset=utf-8",
};

// Scripts and styles come from here alone; nothing is loaded from elsewhere, and no text becomes markup.
export function policy(frameAncestors: "'none'" | "'self'"): string {
  return [
    "default-src 'none'",
    "script-src 'self'",
    "style-src 'self'",
    "img-src 'self' blob: data:",
    "connect-src 'self'",
    "frame-src 'self'",
    "base-uri 'none'",
    "form-action 'none'",
    `frame-ancestors ${frameAncestors}`,
    "require-trusted-types-for 'script'",
    "trusted-types 'none'",
  ].join("; ");
}

export const safeHeaders: Record<string, string> = {
  "X-Content-Type-Options": "nosniff",
  "Referrer-Policy": "no-referrer",
  "Cross-Origin-Opener-Policy": "same-origin",
  "Cross-Origin-Resource-Policy": "same-origin",
  "Permissions-Policy": "camera=(), geolocation=(), microphone=()",
};

export function readFiles(folder: string): Map<string, PageFile> {
  const files = new Map<string, PageFile>();
  for (const name of readdirSync(folder)) {
    const body = readFileSync(join(folder, name));
    const isTemplate = name === "template.html"; // data for the page, which is never shown itself
    const headers: Record<string, string> = {
      ...safeHeaders,
      "Content-Type": isTemplate ? "text/plain; charset=utf-8" : (types[name.split(".").pop()!] ?? "application/octet-stream"),
      "Content-Security-Policy": policy(name === "frame.html" ? "'self'" : "'none'"),
      "Cache-Control": "no-cache",
      ETag: `"${createHash("sha256").update(body).digest("hex").slice(0, 32)}"`,
    };
    files.set(name === "index.html" ? "/" : `/${name}`, { body, headers });
  }
  return files;
}
