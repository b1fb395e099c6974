// Starts the server from the command line.
import { fileURLToPath } from "node:url";
import { help, isLoopback, readOptions, UsageError } from "./options";
import { type RunningServer, startServer } from "./server";

async function main(): Promise<void> {
  const options = readOptions(process.argv.slice(2));
  if (options.help) {
    console.log(help);
    return;
  }
  const running: RunningServer = await startServer(options, fileURLToPath(new URL("public", import.meta.url)));
  if (!isLoopback(options.listen.host)) {
    console.error("patchmill web: anybody who reaches this address can use the page. Put a proxy with TLS and a log-in in front.");
  }
  console.log(running.url);
  for (const signal of ["SIGINT", "SIGTERM"] as const) {
    process.once(signal, () => void running.close().then(() => process.exit(0)));
  }
}

main().catch((error: unknown) => {
  console.error(`patchmill web: ${error instanceof Error ? error.message : String(error)}`);
  process.exit(error instanceof UsageError ? 2 : 1);
});
