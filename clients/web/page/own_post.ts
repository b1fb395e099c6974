// A post file of the user's own: a dialect as text. It goes with the request; the address has its name alone.
import { SettingError } from "./values";

export interface OwnPost {
  name: string;
  text: string;
}

const mostBytes = 100_000; // Post.post_file

// As on the command line, a name with a dot or a slash is that of a file.
export const isFile = (post: string): boolean => /[./\\]/.test(post);
export const settingOfFile = (name: string): string => `./${name}`;

// Reads a post file. It throws an error for the user if it cannot be one.
export async function readPost(file: File): Promise<OwnPost> {
  if (file.size === 0) throw new Error(`"${file.name}" is empty; a post file has sections such as [control] and [begin].`);
  if (file.size > mostBytes) throw new Error(`"${file.name}" has ${file.size} bytes; a post file has at most 100,000.`);
  const bytes = new Uint8Array(await file.arrayBuffer());
  // A post file is ASCII. What is not becomes a sign that the server refuses, naming its line.
  return { name: file.name, text: Array.from(bytes, (b) => (b < 0x80 ? String.fromCharCode(b) : "\u0001")).join("") };
}

export function postTextOf(post: string, own: OwnPost | null): string {
  if (own !== null && post === settingOfFile(own.name)) return own.text;
  const name = post.replace(/^\.\//, "").slice(0, 60);
  throw new SettingError("post", `The page does not have the post file "${name}": files are no part of the address. Choose the file again, or another control.`);
}
