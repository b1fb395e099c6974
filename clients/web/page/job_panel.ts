// The job: start, progress, cancel, what came out, and its files.
import { byId, make } from "../../viewer/src/page_elements";
import { Severity } from "../gen/patchmill/v1/diagnostic_pb.js";
import { Outcome, type Progress, type Report } from "../gen/patchmill/v1/report_pb.js";
import { baseName, download, pageText, programName, reportText } from "./downloads";
import type { JobResult } from "./job";
import { findingRow } from "./part_panel";
import type { Problem } from "./problems";
import { assumedRows, uncutRows, uncutText } from "./result_notes";
import { figuresOf, type PackedScene } from "./scene";
import { settingOf } from "./settings";
import { counted, durationText, shortName } from "./text";

const outcomeTexts: Partial<Record<Outcome, string>> = {
  [Outcome.COMPLETE]: "Complete and verified",
  [Outcome.COMPLETE_WHERE_REACHABLE]: "Verified; complete where the ball reaches",
  [Outcome.NOTHING_TO_CUT]: "Nothing to cut: no program",
  [Outcome.VERIFICATION_FAILED]: "The verification failed: no program",
  [Outcome.NEEDS_ROUGHING]: "The part needs roughing first: no program",
  [Outcome.TOO_MUCH_UNREACHED]: "The ball does not fit into too much of the part: no program",
};

// What helps where no program was made.
const outcomeAdvice: Partial<Record<Outcome, string>> = {
  [Outcome.NOTHING_TO_CUT]: "Turn the part, take a smaller ball, or choose other faces.",
  [Outcome.VERIFICATION_FAILED]: "Please report it with model and settings; a finer tolerance may help until then.",
  [Outcome.NEEDS_ROUGHING]: "Rough the part first and state the allowance, or raise the accepted depth: Stock and clamps, More.",
  [Outcome.TOO_MUCH_UNREACHED]: "Take a smaller ball, choose fewer faces, or allow more: Passes, More, Uncut at most.",
};

// Shows a bar that is true: the share of the stage that runs, and the stages that are done. Nobody knows the whole.
export class ProgressView {
  readonly #start = performance.now();
  readonly #done: string[] = [];
  #stage = "";
  readonly #timer: number;
  #remaining: number | undefined;

  constructor() {
    byId("progress-box").hidden = false;
    byId("stage").textContent = "sending the job";
    byId("percent").textContent = "";
    byId<HTMLProgressElement>("progress").removeAttribute("value");
    this.#tick();
    this.#timer = window.setInterval(() => this.#tick(), 250);
  }

  #tick(): void {
    const left = this.#remaining === undefined ? "" : `, about ${durationText(this.#remaining)} left`;
    byId("elapsed").textContent = `${durationText((performance.now() - this.#start) / 1000)}${left}`;
  }

  show({ stage, fraction, remainingS }: Progress): void {
    if (stage !== this.#stage) {
      if (this.#stage !== "") this.#done.push(this.#stage);
      this.#stage = stage;
    }
    this.#remaining = remainingS;
    const share = Math.min(1, Math.max(0, fraction));
    byId("stage").textContent = stage === "" ? "waiting" : stage;
    byId("percent").textContent = `${Math.floor(100 * share)} %`;
    byId<HTMLProgressElement>("progress").value = share;
    byId("stages-done").textContent = this.#done.length === 0 ? "" : `${counted(this.#done.length, "stage")} done`;
    byId("stages-done").title = this.#done.join(", ");
    this.#tick();
  }

  end(): void {
    clearInterval(this.#timer);
    byId("progress-box").hidden = true;
  }
}

export function showProblem(problem: Problem | null, goTo: (setting: string) => void): void {
  const box = byId("problem");
  box.hidden = problem === null;
  if (problem === null) return;
  const list = make("ul");
  for (const { setting, field, text } of problem.items) {
    const row = make("li");
    const name = setting === null ? field : `\u201c${settingOf(setting).label}\u201d`;
    // What the server says of a field begins with its value: "= -1; must be above 0".
    const whole = text.startsWith("=") ? `${name} ${text}` : text;
    if (setting !== null) {
      const link = make("button", "", "Go to it");
      link.type = "button";
      link.dataset.setting = setting;
      link.addEventListener("click", () => goTo(setting));
      row.append(make("span", "", `${whole} `), link);
    } else row.textContent = whole;
    if (field !== "" && !whole.startsWith(field)) row.append(make("code", "", ` ${field}`));
    list.append(row);
  }
  box.replaceChildren(make("h2", "", problem.title), list);
  if (problem.advice !== "") box.append(make("p", "advice", problem.advice));
  box.scrollIntoView({ block: "nearest" });
}

export interface Finished {
  result: JobResult;
  scene: PackedScene | null; // null: there is nothing to draw
  file: string;
  dialect: string;
}

function toneOf(outcome: Outcome): string {
  return outcome === Outcome.COMPLETE ? "good" : outcome === Outcome.COMPLETE_WHERE_REACHABLE ? "warn" : "bad";
}

// The findings that say why there is no program.
function reasonsOf({ outcome, diagnostics }: Report): HTMLElement[] {
  const own = shortName(Outcome, outcome);
  const rows = diagnostics.filter((d) => d.severity === Severity.ERROR || d.code === own).slice(0, 6).map((d) => findingRow(d, null));
  const advice = outcomeAdvice[outcome];
  if (advice !== undefined) rows.push(make("li", "warn", advice));
  return rows;
}

export class ResultPanel {
  #finished: Finished | null = null;
  #isProgramShown = false;
  readonly #onError: (error: unknown) => void;
  readonly #goTo: (setting: string) => void;

  constructor(onShow: (isProgram: boolean) => void, onError: (error: unknown) => void, goTo: (setting: string) => void) {
    this.#onError = onError;
    this.#goTo = goTo;
    byId("show-program").addEventListener("click", () => onShow(!this.#isProgramShown));
    byId("get-program").addEventListener("click", () => this.#get(({ result, file, dialect }) => download(programName(file, dialect), new Uint8Array(result.program!), "text/plain")));
    byId("get-report").addEventListener("click", () => this.#get(({ result, file }) => download(`${baseName(file)}-report.json`, reportText(result.report), "application/json")));
    byId("get-picture").addEventListener("click", () => this.#get(({ result, file }) => download(`${baseName(file)}.svg`, new Uint8Array(result.picture), "image/svg+xml")));
    byId("get-page").addEventListener("click", () => this.#get(async ({ scene, file }) => download(`${baseName(file)}.html`, await pageText(scene!), "text/html")));
  }

  #get(make: (finished: Finished) => void | Promise<void>): void {
    if (this.#finished === null) return;
    Promise.resolve(make(this.#finished)).catch(this.#onError);
  }

  get finished(): Finished | null {
    return this.#finished;
  }

  set(finished: Finished | null): void {
    this.#finished = finished;
    byId("result").hidden = finished === null;
    if (finished === null) return;
    const { result, scene } = finished;
    const { report } = result;
    byId("outcome").textContent = outcomeTexts[report.outcome] ?? shortName(Outcome, report.outcome);
    byId("outcome").dataset.tone = toneOf(report.outcome);
    byId("stale").hidden = true;
    const figures: [string, string][] = figuresOf(report).map(([n, v]) => [n, n === "not reached" ? uncutText(report) : v]);
    const wanted = result.program === null ? ["not reached"] : ["largest gouge", "largest leftover", "not reached", "time", "stick-out at least"];
    byId("figures").replaceChildren(...figures.filter(([n]) => wanted.includes(n)).flatMap(([n, v]) => [make("dt", "", n), make("dd", "", v)]));
    byId("reasons").replaceChildren(...(result.program === null ? reasonsOf(report) : []));
    const uncut = uncutRows(report, this.#goTo);
    byId("uncut").replaceChildren(...uncut);
    byId("uncut-box").hidden = uncut.length === 0;
    const assumed = result.program === null ? [] : assumedRows(report, this.#goTo);
    byId("assumed").replaceChildren(...assumed);
    byId("assumed-title").textContent = `Check before the start: ${counted(assumed.length, "assumption")}`;
    byId("assumed-box").hidden = assumed.length === 0;
    byId("get-program").hidden = result.program === null;
    byId("get-picture").hidden = result.picture.length === 0;
    byId("get-page").hidden = scene === null;
    byId("show-program").hidden = scene === null || result.program === null;
  }

  setStale(isStale: boolean): void {
    byId("stale").hidden = !isStale || this.#finished === null;
  }

  // Says what the picture shows.
  shows(isProgram: boolean): void {
    this.#isProgramShown = isProgram;
    byId("show-program").textContent = isProgram ? "Show the part" : "Show the program";
  }
}
