// The page: a part comes in, is checked and divided into regions at once, and becomes a program.
import { byId, press } from "../../viewer/src/page_elements";
import type { SplitRegionsResponse } from "../gen/patchmill/v1/analysis_service_pb.js";
import type { Diagnostic } from "../gen/patchmill/v1/diagnostic_pb.js";
import { Severity } from "../gen/patchmill/v1/diagnostic_pb.js";
import type { CheckModelResponse } from "../gen/patchmill/v1/model_service_pb.js";
import { analysis, LatestCall, models, toolpaths } from "./calls";
import { programName } from "./downloads";
import { Form } from "./form";
import type { Clicked } from "./frame/api";
import { runJob } from "./job";
import { type Finished, ProgressView, ResultPanel, showProblem } from "./job_panel";
import { clearPart, showPart, showUpHint, sizeNote, upNotes } from "./part_panel";
import { PickLists } from "./pick_lists";
import { type Problem, problemOf } from "./problems";
import { makeMachinePanel } from "./machine_panel";
import { isFile, type OwnPost } from "./own_post";
import { type DrawRing, PlanEditor, type Point2 } from "./plan";
import { makePostPanel } from "./post_panel";
import { endingOf, knownEndings, makeCheck, makeProgram, makeSplit, makeValidation, type ModelFile } from "./request";
import { colorOf, type PackedScene, packScene, regionName, trianglesOf } from "./scene";
import { Choice, commandOf, settings } from "./settings";
import { marksOf, placeText, type Surface, surfacesOf } from "./surfaces";
import { bytesText, counted, durationText } from "./text";
import { makeToolPanel } from "./tool_panel";
import { View } from "./view";

const maxFileBytes = 64 * 2 ** 20 - 4096; // a request has 64 MiB, and not all of it is the file
const debounceMs = 350;

const choice = new Choice();
const placement = ["length-unit", "up", "scale", "zero", "translate", "skip-face", "border-tolerance", "cap-holes", "wall-side"];
const checkNames = [...placement, "tool-diameter"];
// Regions do not depend on what moves between passes, on the machine, on cutting data, and on the program.
const motionNames = ["spindle", "feed", "plunge-feed", "coolant", "tool-number", "max-unreached"];
const splitNames = settings.filter((s) => !["motion", "machine", "program"].includes(s.group) && !motionNames.includes(s.name)).map((s) => s.name);
const allNames = settings.map((s) => s.name);

let file: ModelFile | null = null;
let check: CheckModelResponse | null = null;
let split: SplitRegionsResponse | null = null;
let map: PackedScene | null = null;
let surfaces: Surface[] = [];
let problem: Problem | null = null;
let clickMode = "look";
let keys = { check: "", split: "", valid: "", job: "" };
let ownPost: OwnPost | null = null;
let postCount = 0; // number of post files that were chosen
let timer = 0;
let ticker = 0;
let isRunning = false;
let isProgramShown = false;
let hasPosts = false;
let opened = 0; // number of files that were chosen

const checkCall = new LatestCall();
const splitCall = new LatestCall();
const validCall = new LatestCall();
const jobCall = new LatestCall();

const view = new View({ onClick, onFile: (f) => void open(f), onTheme: setDark });
const plan = new PlanEditor();
const draw: DrawRing = Object.assign((request: Parameters<DrawRing>[0]) => plan.draw(request), { part: () => plan.part });
const form = new Form(choice, changed, draw);
const lists = new PickLists(choice, changed);
const postPanel = makePostPanel(choice, takePost, (error) => tell(problemOf(error, "Reading the post file")));
const results = new ResultPanel((isProgram) => showScene(isProgram ? (results.finished?.scene ?? null) : map, isProgram), (e) => tell(problemOf(e, "The download")), (name) => form.goTo(name));

function tell(next: Problem | null): void {
  problem = next;
  showProblem(problem, (name) => form.goTo(name));
  form.mark(problem);
}

function setState(id: string, text: string, isBad = false): void {
  byId(id).textContent = text;
  byId(id).dataset.tone = isBad ? "bad" : "";
}

// Settings

function changed(name: string): void {
  history.replaceState(null, "", `#${choice.toHash()}`);
  refresh();
  if (name === "only" || name === "avoid") view.api?.shade("marks");
}

// Shows the settings everywhere, and asks anew for what depends on them.
function refresh(): void {
  form.fill();
  lists.fill();
  showMarks();
  showCommand();
  if (problem !== null) tell(null);
  results.setStale(keys.job !== jobKey());
  window.clearTimeout(timer);
  timer = window.setTimeout(update, debounceMs);
}

// Everything that decides the program of a part.
const jobKey = (): string => `${choice.keyOf(allNames)} ${isFile(choice.get("post")) ? postCount : 0}`;

function showMarks(): void {
  view.mark(marksOf(surfaces, choice), choice.list("only").length === 0);
}

function showCommand(): void {
  const name = file?.name ?? "part.step";
  byId("command").textContent = commandOf(choice, name, programName(name, choice.get("post")));
  const files = [choice.list("machine-x").length > 0 ? "the machine, saved as machine.json (Machine, Save as a file)" : "", isFile(choice.get("post")) ? "your post file" : ""].filter(Boolean);
  const needed = files.length === 0 ? "" : ` The command also reads ${files.join(" and ")}.`;
  byId("command-note").textContent = `The address of this page holds the same settings, but no files: part and post file stay with you.${needed}`;
}

function update(): void {
  if (file === null || isRunning) return;
  const checkKey = choice.keyOf(checkNames);
  if (checkKey !== keys.check) {
    keys.check = checkKey;
    void runCheck(file);
  }
  const splitKey = choice.keyOf(splitNames);
  if (splitKey !== keys.split) {
    keys.split = splitKey;
    void runSplit(file);
  }
  if (jobKey() !== keys.valid) {
    keys.valid = jobKey();
    void runValidation(file);
  }
}

// Shows at once what is wrong with any setting, whether the picture depends on it or not.
async function runValidation(of: ModelFile): Promise<void> {
  try {
    const request = makeValidation(of, choice, ownPost);
    await validCall.run(async (signal) => {
      for await (const _ of toolpaths.generateProgram(request, { signal }));
    });
  } catch (error) {
    if (problem === null) tell(problemOf(error, "The job"));
  }
}

function takePost(post: OwnPost): void {
  ownPost = post;
  postCount++;
  form.addPost(post.name);
  changed("post");
}

// The part

async function open(chosen: File): Promise<void> {
  const own = ++opened;
  jobCall.cancel();
  checkCall.cancel();
  validCall.cancel();
  stopSplit();
  plan.setPart(null);
  file = check = split = map = null;
  surfaces = [];
  keys = { check: "", split: "", valid: "", job: "" };
  view.clear();
  clearPart();
  results.set(null);
  lists.setSurfaces([], false);
  lists.setRegions([]);
  setState("split-state", "");
  setState("job-state", "");
  tell(null);
  showEmpty("There is no picture.", "What is wrong stands beside the start button.");
  byId("file-name").textContent = chosen.name;
  byId("file-name").title = chosen.name;
  byId<HTMLButtonElement>("start").disabled = true;
  if (!knownEndings.includes(endingOf(chosen.name))) {
    setState("check-state", "");
    const text = `"${chosen.name}" has no ending that Patchmill reads.`;
    tell({ title: "The part was not read", items: [{ setting: null, field: "", text }], advice: `Choose a file that ends in ${knownEndings.map((e) => `.${e}`).join(", ")}.` });
    return;
  }
  if (chosen.size > maxFileBytes) {
    setState("check-state", "");
    const text = `"${chosen.name}" has ${bytesText(chosen.size)}; a request has at most 64 MiB.`;
    tell({ title: "The part was not read", items: [{ setting: null, field: "", text }], advice: "Export less of the part, or export it without facets." });
    return;
  }
  try {
    const bytes = new Uint8Array(await chosen.arrayBuffer());
    if (own !== opened) return; // another file was chosen meanwhile
    file = { name: chosen.name, bytes };
  } catch (error) {
    tell(problemOf(error, "Reading the file"));
    return;
  }
  byId<HTMLButtonElement>("start").disabled = false;
  showEmpty("The part is read \u2026", "It is checked and divided into regions.");
  document.title = `${chosen.name} \u2013 Patchmill`;
  showCommand();
  update();
  void loadPosts();
}

function showEmpty(title: string, more: string): void {
  byId("empty-title").textContent = title;
  byId("empty-text").textContent = more;
}

async function runCheck(of: ModelFile): Promise<void> {
  setState("check-state", "The part is checked \u2026");
  try {
    const answer = await checkCall.run(async (signal) => models.checkModel(makeCheck(of, choice), { signal }));
    if (answer === null) return;
    check = answer;
    const errors = check.diagnostics.filter((d) => d.severity === Severity.ERROR).length;
    const note = sizeNote(check, Number(choice.get("tool-diameter") || 6));
    setState("check-state", errors === 0 ? note : `The part cannot be milled: it has ${counted(errors, "error")}.`, errors > 0);
    showPart(check, showPlace);
    setPlan();
    form.describeUp(upNotes(check));
    showUpHint(check, choice.get("up"), (up) => {
      choice.set("up", up);
      changed("up");
    });
    setSurfaces();
  } catch (error) {
    setState("check-state", "The part was not checked.", true);
    tell(problemOf(error, "Checking the part"));
  }
}

// The part from above, with what is known of it.
function setPlan(): void {
  const { min, max } = check?.box ?? {};
  if (min === undefined || max === undefined) return plan.setPart(null);
  const empty = { position: new Float32Array(0), index: new Uint32Array(0) };
  const { stock, clamps } = (map?.header ?? {}) as { stock?: { outline: Point2[] } | null; clamps?: { outline: Point2[] }[] };
  plan.setPart({
    min: [min.xMm, min.yMm, min.zMm],
    max: [max.xMm, max.yMm, max.zMm],
    ...(map === null ? empty : trianglesOf(map)),
    others: [...(stock === undefined || stock === null ? [] : [stock.outline]), ...(clamps ?? []).map((c) => c.outline)],
  });
}

function showPlace({ code, message }: Diagnostic): void {
  if (isProgramShown) {
    void showScene(map, false).then(() => view.api?.findPlace(code, message));
  } else view.api?.findPlace(code, message);
}

function setSurfaces(): void {
  surfaces = surfacesOf(check, split, map?.surfaces ?? []);
  lists.setSurfaces(surfaces, (check?.faces.length ?? 0) > 0);
  showMarks();
}

// The regions

async function runSplit(of: ModelFile): Promise<void> {
  const start = performance.now();
  const tick = (): void => setState("split-state", `Regions are computed \u2026 ${durationText((performance.now() - start) / 1000)}`);
  window.clearInterval(ticker);
  ticker = window.setInterval(tick, 1000);
  setState("split-state", "Regions are computed \u2026");
  splitCall.cancel();
  try {
    const request = makeSplit(of, choice);
    const answer = await splitCall.run((signal) => analysis.splitRegions(request, { signal }));
    if (answer === null) return;
    window.clearInterval(ticker);
    split = answer;
    const { setup, operations, name } = request.job!;
    const operation = operations[0]!;
    map = packScene({
      title: name,
      version: "",
      setup,
      tool: operation.tool,
      tolerance: operation.toleranceMm,
      scallop: operation.scallopMm,
      steepAngle: operation.steepAngleDeg ?? 45,
      regions: answer.regions,
      mesh: answer.mesh,
      paths: [],
      program: null,
      report: null,
      findings: answer.diagnostics,
    });
    const regions = answer.regions?.regions ?? [];
    lists.setRegions(regions.filter((r) => r.insidePoint !== undefined).map((r) => ({ id: r.id, place: placeText(r.insidePoint!), name: regionName(r), color: colorOf(r) })));
    setSurfaces();
    setPlan();
    const seconds = ((performance.now() - start) / 1000).toFixed(1);
    setState("split-state", `${counted(regions.length, "region")}, computed in ${seconds} s`);
    if (!isRunning && !(results.finished !== null && keys.job === jobKey())) {
      await showScene(map, false);
    }
  } catch (error) {
    window.clearInterval(ticker);
    setState("split-state", "No regions: see what is wrong.", true);
    showEmpty("There is no picture.", "What is wrong stands beside the start button.");
    if (problem === null) tell(problemOf(error, "Computing the regions"));
  }
}

// Ends a running division into regions. It begins anew with the next update.
function stopSplit(): void {
  if (!splitCall.isRunning) return;
  splitCall.cancel();
  window.clearInterval(ticker);
  setState("split-state", "");
  keys.split = "";
}

async function showScene(scene: PackedScene | null, isProgram: boolean): Promise<void> {
  if (scene === null) return;
  isProgramShown = isProgram;
  results.shows(isProgram);
  try {
    await view.show(scene, isProgram);
    if (!isProgram) showMarks();
  } catch (error) {
    tell(problemOf(error, "The 3-D view"));
  }
}

function onClick({ surface, region }: Clicked): void {
  if (clickMode === "region") {
    if (region !== null) lists.toggleRegion(region);
    return;
  }
  const found = surfaces.find((s) => s.name === surface);
  if (found === undefined) return;
  if (clickMode === "up") {
    if (!found.isPlane) {
      tell({ title: "The part is not turned", items: [{ setting: "up", field: "", text: `${found.name} is not a plane face.` }], advice: "Click a plane face, or choose an axis." });
      return;
    }
    choice.set("up", found.selector);
    changed("up");
  } else if (clickMode === "mill" || clickMode === "avoid") {
    lists.toggle(found.selector, clickMode === "mill" ? "only" : "avoid");
  }
}

function setClickMode(mode: string): void {
  clickMode = mode;
  for (const button of document.querySelectorAll<HTMLElement>("[data-click]")) press(button, button.dataset.click === mode);
  view.setPicking(mode !== "look");
  if (mode === "look") return;
  if (results.finished !== null && map !== null && isProgramShown) {
    void showScene(map, false).then(() => shadeFor(mode));
  } else shadeFor(mode);
  if (mode !== "up") byId<HTMLDetailsElement>("area-box").open = true;
}

const shadeFor = (mode: string): void => view.api?.shade(mode === "region" ? "region" : "marks");

// The job

async function start(): Promise<void> {
  if (file === null || isRunning) return;
  const of = file;
  tell(null);
  setState("job-state", "");
  let progress: ProgressView | null = null;
  try {
    const request = makeProgram(of, choice, ownPost);
    showEmpty("The job runs.", "The program is shown when it is verified.");
    validCall.cancel();
    stopSplit(); // the job makes its own, and has the processor for itself
    setRunning(true);
    results.set(null);
    progress = new ProgressView();
    const result = await jobCall.run((signal) => runJob(request, signal, (p) => progress?.show(p)));
    if (result === null) return;
    const operation = request.job!.operations[0]!;
    const source = {
      title: request.job!.name,
      tool: operation.tool,
      tolerance: operation.toleranceMm,
      scallop: operation.scallopMm,
      steepAngle: operation.steepAngleDeg ?? 45,
      findings: result.report.diagnostics,
    };
    const scene = result.mesh.length === 0 ? null : packScene({ ...source, ...result });
    const finished: Finished = { result, scene, file: of.name, dialect: choice.get("post") };
    // The messages are as large as the scene, and the scene has all of them.
    [result.mesh, result.paths] = [[], []];
    keys.job = jobKey();
    results.set(finished);
    await showScene(scene, result.program !== null);
  } catch (error) {
    tell(problemOf(error, "The job"));
  } finally {
    progress?.end();
    setRunning(false);
    update();
  }
}

function setRunning(on: boolean): void {
  isRunning = on;
  byId<HTMLButtonElement>("start").disabled = on || file === null;
  byId("start").hidden = on;
  byId("cancel").hidden = !on;
}

function cancel(): void {
  jobCall.cancel();
  setState("job-state", "The job was cancelled. Nothing of it is kept.");
}

// The page itself

function setDark(isDark: boolean): void {
  document.documentElement.dataset.theme = isDark ? "dark" : "light";
  byId("dark").textContent = isDark ? "Light" : "Dark";
  view.setDark(isDark);
}

function followFiles(): void {
  const input = byId<HTMLInputElement>("file");
  input.addEventListener("change", () => {
    const chosen = input.files?.[0];
    if (chosen !== undefined) void open(chosen);
    input.value = ""; // the same file may be chosen again
  });
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    document.body.classList.add("dropping");
  });
  document.addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) document.body.classList.remove("dropping");
  });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    const dropped = event.dataTransfer?.files[0];
    if (dropped !== undefined) void open(dropped);
  });
}

function readAddress(): void {
  const unknown = choice.fromHash(location.hash);
  if (unknown.length > 0) {
    const text = `The address has settings that do not exist: ${unknown.join(", ").slice(0, 200)}. They are left out.`;
    tell({ title: "The address", items: [{ setting: null, field: "", text }], advice: "" });
  }
  form.fill();
  lists.fill();
  showCommand();
}

async function loadPosts(): Promise<void> {
  if (hasPosts) return;
  try {
    const { posts } = await toolpaths.listPosts({});
    form.setPosts(posts);
    postPanel.setPosts(posts);
    hasPosts = true;
  } catch (error) {
    tell(problemOf(error, "Asking patchmilld for its dialects"));
  }
}

const darkQuery = matchMedia("(prefers-color-scheme: dark)");
setDark(darkQuery.matches);
darkQuery.addEventListener("change", () => setDark(darkQuery.matches));
byId("dark").addEventListener("click", () => setDark(document.documentElement.dataset.theme !== "dark"));
// As a new address, so that the browser's way back brings the settings back.
byId("reset").addEventListener("click", () => (location.hash = ""));
for (const button of document.querySelectorAll<HTMLElement>("[data-click]")) button.addEventListener("click", () => setClickMode(button.dataset.click!));
// Enter ends the input of a value; a job is started by its button alone.
byId("settings").addEventListener("keydown", (event) => {
  if (event.key === "Enter" && event.target instanceof HTMLInputElement && event.target.type !== "file") event.preventDefault();
});
document.addEventListener("keydown", (event) => {
  if (event.key !== "Enter" || !(event.ctrlKey || event.metaKey) || document.querySelector("dialog[open]") !== null) return;
  event.preventDefault();
  void start();
});
byId("settings").addEventListener("submit", (event) => {
  event.preventDefault();
  void start();
});
byId("cancel").addEventListener("click", cancel);
window.addEventListener("hashchange", () => {
  readAddress();
  refresh();
});
makeMachinePanel(choice, changed, (error) => tell(problemOf(error, "The machine")));
makeToolPanel(choice, changed, (error) => tell(problemOf(error, "Reading the tool")));
followFiles();
readAddress();
void loadPosts();
