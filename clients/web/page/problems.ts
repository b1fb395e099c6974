// Says what went wrong, where, and what to do.
import { Code, ConnectError } from "@connectrpc/connect";
import { type ErrorInfo, ErrorInfoSchema } from "../gen/patchmill/v1/status_pb.js";
import { settings } from "./settings";
import { brief, inWords, sentence } from "./text";
import { SettingError } from "./values";

export interface ProblemItem {
  setting: string | null; // the setting that is wrong
  field: string; // its path in the request; empty if it is not of a request
  text: string;
}

export interface Problem {
  title: string;
  items: ProblemItem[];
  advice: string;
}

// The setting whose field ends as the path does.
export function settingOfField(path: string): string | null {
  const plain = path.replace(/\[\d+\]/g, "");
  let best = "";
  let name: string | null = null;
  for (const setting of settings) {
    for (const field of setting.fields ?? []) {
      const whole = field.includes("[") ? path : plain;
      const isIt = whole === field || whole.endsWith(`.${field}`) || whole.includes(`.${field}.`);
      if (isIt && field.length > best.length) [best, name] = [field, setting.name];
    }
  }
  return name;
}

const adviceOfReason: Record<string, string> = {
  INVALID_FIELDS: "Correct the settings that are marked.",
  NOT_IMPLEMENTED: "Leave this setting at its default.",
  MODEL_UNREADABLE: "Check that the file is whole and that its ending says its format. Faces that cannot be read can be left out: Part, More, Faces left out.",
  MODEL_INVALID: "Repair the model. The findings of the part say what is wrong.",
  TOO_MANY_JOBS: "Wait until another job has ended, then start again.",
  TOO_MANY_BYTES: "Wait until other calls have ended, then try again.",
  TOO_MUCH_MEMORY: "Wait until other jobs have ended, then start again.",
  DRAINING: "patchmilld shuts down. Start it again, then try again.",
  REGIONS_STALE: "Take the changes to regions back, and choose them anew.",
  DEADLINE_EXCEEDED: "Take a larger scallop or less of the part, or start patchmilld with --max-job-seconds.",
  INTERNAL: "This is a fault of Patchmill. Please report it with the model and the command below the program.",
};

const adviceOfCode: Partial<Record<Code, string>> = {
  [Code.Unavailable]: "Start patchmilld, then try again.",
  [Code.PermissionDenied]: "Open the page by the address that scripts/web.sh prints.",
  [Code.Unauthenticated]: "Log in again, then try again.",
  [Code.ResourceExhausted]: "Send a smaller model, or wait until other calls have ended.",
  [Code.DeadlineExceeded]: "Take a larger scallop or less of the part.",
};

function limitText({ limit, limitValue, actualValue }: ErrorInfo): string {
  return limit === "" ? "" : `The limit ${limit} is ${brief(limitValue, 9)}, and this has ${brief(actualValue, 9)}.`;
}

export function problemOf(error: unknown, what: string): Problem {
  if (error instanceof SettingError) {
    return { title: `${what} needs other settings`, items: [{ setting: error.setting, field: "", text: error.message }], advice: "Correct the setting that is marked." };
  }
  if (!(error instanceof ConnectError)) {
    const text = error instanceof Error ? error.message : String(error);
    return { title: `${what} failed`, items: [{ setting: null, field: "", text }], advice: "" };
  }
  if (error.cause instanceof TypeError || /failed to fetch|networkerror|load failed/i.test(error.rawMessage)) {
    const text = "The server of this page does not answer, or it ended the connection.";
    return { title: `${what} failed`, items: [{ setting: null, field: "", text }], advice: "Start scripts/web.sh again. The settings are in the address and stay." };
  }
  const info = error.findDetails(ErrorInfoSchema)[0];
  const items: ProblemItem[] = (info?.fieldViolations ?? []).map(({ field, description }) => ({ setting: settingOfField(field), field, text: inWords(description) }));
  if (info !== undefined && info.violationCount > items.length) {
    items.push({ setting: null, field: "", text: `${info.violationCount - items.length} more fields are wrong.` });
  }
  if (items.length === 0) items.push({ setting: null, field: "", text: error.rawMessage === "" ? (Code[error.code] ?? "unknown") : sentence(inWords(error.rawMessage)) });
  const limit = info === undefined ? "" : limitText(info);
  if (limit !== "") items.push({ setting: null, field: "", text: limit });
  if (info?.reason === "INVALID_FIELDS" && items.every((item) => item.setting === null)) {
    return { title: `${what} failed`, items, advice: "Correct the file, or choose another one." };
  }
  if (info?.reason === "INVALID_FIELDS") return { title: `${what} needs other settings`, items, advice: adviceOfReason.INVALID_FIELDS! };
  if (info?.reason === "NOT_IMPLEMENTED" && items.every((item) => item.field === "")) {
    const isReader = /importer|STEP|IGES/.test(error.rawMessage);
    const reader = "Install the reader of CAD files with scripts/setup.sh cad, build, and start again. Parts as .json or .pb need no reader.";
    return { title: `${what} failed`, items, advice: isReader ? reader : "This version of patchmilld cannot do it." };
  }
  const advice = adviceOfReason[info?.reason ?? ""] ?? adviceOfCode[error.code] ?? "";
  return { title: `${what} failed`, items, advice };
}
