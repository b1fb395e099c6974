// The text of the program. Only the lines in view are elements of the page, however long the program is.
import { byId, make, option } from "./page_elements";
import { firstMoves } from "./program_text";
import type { Viewer } from "./viewer";

const lineHeight = 18; // px, as in page.css
const tallest = 4_000_000; // px: browsers cannot scroll much farther

export class ProgramPanel {
  readonly #viewer: Viewer;
  readonly #box = byId("lines");
  readonly #space = byId("lines-space");
  readonly #shown = byId("lines-shown");
  readonly #lines: number;
  readonly #scale: number; // lines per line height of scrolling
  #firstMoves: Uint32Array | null = null;
  #current = 0;
  #top = 0; // the first line in view, from 0; it may lie between two lines
  #ownScroll = -1; // the scroll position that the panel set itself

  constructor(viewer: Viewer) {
    this.#viewer = viewer;
    this.#lines = viewer.program?.lines ?? 0;
    const height = this.#lines * lineHeight;
    this.#scale = Math.max(1, height / tallest);
    this.#space.style.height = `${height / this.#scale}px`;
    if (this.#lines === 0) this.#shown.append(make("p", "hint", "The scene has no program text."));
    this.#box.addEventListener("scroll", () => {
      if (Math.abs(this.#box.scrollTop - this.#ownScroll) < 1) return;
      this.#top = this.#topOfScroll(this.#box.scrollTop);
      this.draw();
    });
    // One notch of the wheel is the same number of lines in every program.
    this.#box.addEventListener(
      "wheel",
      (event) => {
        if (this.#scale === 1 || event.ctrlKey) return;
        event.preventDefault();
        this.scrollTo(this.#top + (event.deltaMode === 1 ? event.deltaY : event.deltaY / lineHeight));
      },
      { passive: false },
    );
    this.#box.addEventListener("click", (event) => {
      const line = (event.target as HTMLElement).closest<HTMLElement>(".line")?.dataset.line;
      if (line !== undefined) this.goTo(Number(line));
    });
    this.#box.addEventListener("keydown", (event) => {
      const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: this.#visible - 1, PageUp: 1 - this.#visible, Home: -this.#lines, End: this.#lines };
      const step = steps[event.key];
      if (step === undefined || this.#lines === 0) return;
      event.preventDefault();
      event.stopPropagation();
      this.goTo(Math.min(this.#lines, Math.max(1, this.#current + step)));
    });
    viewer.on("time", () => this.follow());
    new ResizeObserver(() => this.draw()).observe(this.#box);
    this.#fillSections();
    this.follow();
    this.draw();
  }

  get #visible(): number {
    return Math.max(1, Math.floor(this.#box.clientHeight / lineHeight));
  }

  get #lastTop(): number {
    return Math.max(0, this.#lines - this.#box.clientHeight / lineHeight);
  }

  #topOfScroll(scroll: number): number {
    const range = this.#box.scrollHeight - this.#box.clientHeight;
    return range <= 0 ? 0 : (scroll / range) * this.#lastTop;
  }

  scrollTo(top: number): void {
    this.#top = Math.min(this.#lastTop, Math.max(0, top));
    const range = this.#box.scrollHeight - this.#box.clientHeight;
    this.#box.scrollTop = this.#lastTop > 0 ? (this.#top / this.#lastTop) * range : 0;
    this.#ownScroll = this.#box.scrollTop;
    this.draw();
  }

  // Goes to the first move of a line.
  goTo(line: number): void {
    const { scene, timeline } = this.#viewer;
    const lines = scene.path?.line;
    if (!lines || timeline === null) {
      this.#setCurrent(line);
      return;
    }
    this.#firstMoves ??= firstMoves(lines, this.#lines);
    this.#viewer.setPlace({ move: this.#firstMoves[line]!, share: 1 });
    this.#setCurrent(line); // a line without a move of its own stays chosen
  }

  follow(): void {
    const line = this.#viewer.scene.path?.line?.[this.#viewer.place.move] ?? 0;
    if (line > 0 && line !== this.#current) this.#setCurrent(line);
    const section = this.#viewer.scene.header.sections.findLastIndex((s) => s.first_move <= this.#viewer.place.move);
    byId<HTMLSelectElement>("sections").value = String(section);
  }

  #setCurrent(line: number): void {
    this.#current = line;
    const at = line - 1 - this.#top;
    if (at < 1 || at > this.#visible - 2) this.scrollTo(line - 1 - this.#visible / 2);
    else this.draw();
  }

  draw(): void {
    if (this.#lines === 0 || this.#box.clientHeight === 0) return;
    const first = Math.floor(this.#top);
    const digits = String(this.#lines).length;
    const rows: HTMLElement[] = [];
    for (let n = first + 1; n <= Math.min(this.#lines, first + this.#visible + 2); n++) {
      const row = make("div", "line");
      row.dataset.line = String(n);
      row.setAttribute("role", "option");
      row.setAttribute("aria-selected", String(n === this.#current));
      const number = make("i", "", String(n));
      number.style.minWidth = `${digits}ch`;
      row.append(number, make("span", "", this.#viewer.program!.line(n)));
      if (n === this.#current) row.id = "current-line";
      rows.push(row);
    }
    this.#shown.replaceChildren(...rows);
    this.#shown.style.transform = `translateY(${this.#box.scrollTop - (this.#top - first) * lineHeight}px)`;
    this.#box.setAttribute("aria-activedescendant", "current-line");
  }

  #fillSections(): void {
    const { sections } = this.#viewer.scene.header;
    const select = byId<HTMLSelectElement>("sections");
    byId("sections-row").hidden = sections.length === 0;
    sections.forEach((s, i) => select.append(option(String(i), s.name)));
    select.addEventListener("change", () => {
      const section = sections[Number(select.value)];
      if (section !== undefined) this.#viewer.setPlace({ move: section.first_move, share: 1 });
    });
  }
}
