// Takes headers and manuals out of the Node.js that npm installed. Nobody compiles against it, and the lint of the project
// reads every header below clients/.
import { rmSync } from "node:fs";
import { fileURLToPath } from "node:url";

for (const machine of ["x64", "arm64"]) {
  for (const part of ["include", "share", "CHANGELOG.md", "README.md"]) {
    rmSync(fileURLToPath(new URL(`node_modules/node-linux-${machine}/${part}`, import.meta.url)), { recursive: true, force: true });
  }
}
