// The settings of a job: their names, texts and defaults. They are the options of `patchmill mill`, so that an address, a
// command line and a page mean the same. A value is kept as the text that was typed; nothing is rounded.

export type Kind = "number" | "whole" | "choice" | "flag" | "text" | "lines" | "list";
export type Group = "part" | "tool" | "finish" | "stock" | "area" | "passes" | "motion" | "machine" | "program";

export interface Setting {
  name: string; // of the option, without dashes
  group: Group;
  kind: Kind;
  label: string;
  unit?: string;
  default: string; // "": not stated
  choices?: readonly (readonly [value: string, label: string])[];
  hint?: string; // what stands in an empty field
  help: string;
  fields?: readonly string[]; // ends of the paths of its fields in the contract; with an index only that element
  isRare?: true; // shown under "More"
}

const s = (name: string, group: Group, kind: Kind, label: string, rest: Omit<Setting, "name" | "group" | "kind" | "label" | "default"> & { default?: string }): Setting => ({
  default: "",
  ...rest,
  name,
  group,
  kind,
  label,
});

export const settings: readonly Setting[] = [
  s("up", "part", "text", "Up", { default: "z", help: "What points up on the machine: an axis of the model, the axis that shows most (auto), or a plane face (f12).", fields: ["setup.up", "up_face"] }),
  s("scale", "part", "number", "Scale", { default: "1", help: "The model is multiplied by this.", fields: ["scale"] }),
  s("length-unit", "part", "choice", "Unit of the file", { choices: [["", "as the file says, else mm"], ["mm", "mm"], ["inch", "inch"], ["m", "m"]], help: "Unit of a model file that states none (.bpt, .bv, .bez, .patches).", fields: ["source.file.length_unit"], isRare: true }),
  s("zero", "part", "text", "Program zero", { hint: "origin of the model", help: "Point of the part that is X0 Y0 Z0: origin, top-center, bottom-corner, or X,Y,Z. Not stated: the origin, with a warning.", fields: ["program_zero.x_mm", "program_zero.y_mm", "program_zero.z_mm", "zero_anchor"] }),
  s("translate", "part", "text", "Shift", { hint: "X,Y,Z", unit: "mm", help: "The model is shifted by this after it is scaled and turned.", fields: ["translation.x_mm", "translation.y_mm", "translation.z_mm"], isRare: true }),
  s("skip-face", "part", "list", "Faces left out", { help: "CAD files: these faces are not read (f12), for instance those that cannot be. The tool keeps off a box around each.", fields: ["skip_faces"], isRare: true }),
  s("border-tolerance", "part", "number", "Borders of faces", { unit: "mm", hint: "0.0001", help: "CAD files: how far the borders of patches may lie from the edges of faces where they cannot follow them exactly, in the file.", fields: ["border_tolerance_mm"], isRare: true }),
  s("cap-holes", "part", "number", "Holes closed", { unit: "mm", help: "Round holes of at most this diameter are closed by caps over their mouths, and the finish runs over them.", fields: ["cap_holes_mm"], isRare: true }),
  s("wall-side", "part", "lines", "Sides of walls", { hint: "f7=0,-30,5", help: "One in each line: NAME=X,Y,Z, an upright wall that nothing else decides, and a point on the side where the tool stands, in coordinates of the placed model.", fields: ["wall_sides", "wall_sides.patch_id", "wall_sides.air"], isRare: true }),

  s("tool-diameter", "tool", "number", "Ball diameter", { unit: "mm", hint: "6", help: "Diameter of the ball.", fields: ["ball_end.diameter_mm"] }),
  s("flute-length", "tool", "number", "Flute length", { unit: "mm", hint: "not stated", help: "Cutting length from the tip. Not stated: it is not checked.", fields: ["flute_length_mm"] }),
  s("shank-diameter", "tool", "number", "Shank diameter", { unit: "mm", hint: "as the ball", help: "Diameter above the flutes. A wider shank needs the flute length.", fields: ["shank_diameter_mm"] }),
  s("stickout", "tool", "number", "Stick-out", { unit: "mm", hint: "not stated", help: "Length from the tip to the holder. The report says how much is needed.", fields: ["stickout_mm"] }),
  s("holder", "tool", "text", "Holder", { hint: "25,32 20,32,50", help: "Segments from below, apart by spaces: LENGTH,DIAMETER, or LENGTH,LOWER,UPPER for a cone, in mm. It needs the stick-out.", fields: ["tool.holder"] }),
  s("spindle", "tool", "number", "Spindle", { unit: "1/min", hint: "default", help: "Spindle speed. Not stated: a default, with a warning.", fields: ["spindle_rpm"] }),
  s("feed", "tool", "number", "Feed", { unit: "mm/min", hint: "default", help: "Cutting feed. Not stated: a default, with a warning.", fields: ["tool.feed_mm_per_min"] }),
  s("plunge-feed", "tool", "number", "Plunge feed", { unit: "mm/min", hint: "default", help: "Feed of steep descents. Not stated: a third of the feed, with a warning.", fields: ["plunge_feed_mm_per_min"] }),
  s("coolant", "tool", "choice", "Coolant", { default: "off", choices: [["off", "off"], ["flood", "flood (M8)"], ["mist", "mist (M7)"], ["air", "air"]], help: "Coolant while cutting." }),
  s("tool-number", "tool", "whole", "Tool number", { hint: "1", help: "The T word. Not stated: 1, with a warning.", fields: ["tool.number"], isRare: true }),
  s("holder-clearance", "tool", "number", "Around the holder", { unit: "mm", hint: "0.5", help: "Distance kept around the holder and below it.", fields: ["holder_clearance_mm"], isRare: true }),

  s("scallop", "finish", "number", "Scallop", { default: "0.01", unit: "mm", help: "Highest ridge between two passes. Step-over and z-step follow from it.", fields: ["scallop_mm"] }),
  s("tolerance", "finish", "number", "Tolerance", { default: "0.01", unit: "mm", help: "The whole error budget: chords, rounding and the smoothing of the control together.", fields: ["tolerance_mm"] }),
  s("leave", "finish", "number", "Stock to leave", { default: "0", unit: "mm", help: "Material that stays everywhere along the normal.", fields: ["stock_to_leave_mm"] }),

  s("stock", "stock", "text", "Body", { hint: "not stated", help: "The stock as it lies on the machine, up to its top: a block around the part, a round bar, or an outline in plan. It has no lower end.", fields: ["stock.block.margin_mm", "stock.cylinder.diameter_mm", "stock.cylinder.center_xy_mm", "stock.outline.outline_xy_mm", "setup.stock.body"] }),
  s("allowance", "stock", "number", "Allowance", { unit: "mm", hint: "0.5, assumed", help: "Material that the operation before left along the normal. When it is stated, rapids may run low.", fields: ["stock.allowance_mm"] }),
  s("allowance-walls", "stock", "number", "Allowance of walls", { unit: "mm", hint: "allowance", help: "Where roughing has left more or less on walls. On a slope it lies between both.", fields: ["stock.wall_allowance_mm"], isRare: true }),
  s("allowance-floors", "stock", "number", "Allowance of floors", { unit: "mm", hint: "allowance", help: "Where roughing has left more or less on floors.", fields: ["stock.floor_allowance_mm"], isRare: true }),
  s("stock-top", "stock", "number", "Top of the stock", { unit: "mm", hint: "part + allowance", help: "Highest material, Z of the program.", fields: ["stock.top_z_mm"] }),
  s("accept-depth", "stock", "number", "Accepted depth", { default: "0", unit: "mm", help: "How deep passes may cut into the stock where that is more than the allowance.", fields: ["accept_depth_mm"], isRare: true }),
  s("obstacle", "stock", "lines", "Clamps", { hint: "vice=12,2: -40,-20 -30,-20 -30,20 -40,20", help: "One in each line: NAME=TOP,MARGIN: X,Y X,Y X,Y. The tool keeps off them on every move.", fields: ["setup.obstacles"], isRare: true }),

  s("only", "area", "list", "Milled", { help: "Faces or patches that are milled. None: all of them.", fields: ["selection.patch_ids"] }),
  s("avoid", "area", "list", "Avoided", { help: "Faces or patches that the tool keeps off.", fields: ["avoid_patch_ids"] }),
  s("avoid-margin", "area", "number", "Distance to avoided", { default: "0", unit: "mm", help: "Distance between the tool and what is avoided.", fields: ["avoid_margin_mm"] }),
  s("outside", "area", "flag", "Mill the outer walls", { help: "Upright walls on the outer border of the part are milled, too. The tool goes down beside the part there.", fields: ["mill_outside"] }),
  s("floor", "area", "number", "Lowest tip", { unit: "mm", hint: "lowest point", help: "The tip goes no lower than this Z.", fields: ["floor_z_mm"] }),
  s("top", "area", "number", "Highest tip", { unit: "mm", hint: "no limit", help: "The ball cuts no higher than with its tip at this Z.", fields: ["heights.top_z_mm"] }),
  s("boundary", "area", "lines", "Boundary", { hint: "0,0 60,0 60,40 0,40", help: "Closed outline in plan, one ring in each line: X,Y X,Y X,Y.", fields: ["boundary_xy_mm", "more_boundary_rings"], isRare: true }),
  s("boundary-mode", "area", "choice", "It limits", { default: "center", choices: [["contact", "contact points"], ["center", "the tool axis"], ["inside", "the whole ball"], ["outside", "the edge of the ball"]], help: "What the boundary limits.", fields: ["boundary_mode"], isRare: true }),
  s("boundary-offset", "area", "number", "Offset of the boundary", { default: "0", unit: "mm", help: "Above 0 it widens the boundary, below 0 it narrows it.", fields: ["boundary_offset_mm"], isRare: true }),
  s("region", "area", "list", "Regions", { help: "Changes to single regions: X,Y,Z:off, or X,Y,Z:contour, X,Y,Z:zigzag.", fields: ["region_overrides"] }),

  s("strategy", "passes", "choice", "Strategy", { default: "auto", choices: [["auto", "by slope"], ["contour", "contours only"], ["zigzag", "lines only"]], help: "By slope: contours cut steep areas, zig-zag lines gentle ones. Or one of them cuts everything.", fields: ["strategy"] }),
  s("steep-angle", "passes", "number", "Steep from", { default: "45", unit: "\u00b0", help: "Slope from which on contours cut instead of zig-zag lines.", fields: ["steep_angle_deg"] }),
  s("zigzag-angle", "passes", "number", "Direction of lines", { default: "0", unit: "\u00b0", help: "Direction of zig-zag lines from +X, counter-clockwise.", fields: ["zigzag_angle_deg"] }),
  s("auto-angle", "passes", "flag", "Find the fastest direction", { help: "The lines of each region run in the direction that takes the least time. The job is planned some 20 times.", fields: ["zigzag_angle_auto"] }),
  s("direction", "passes", "choice", "Contours", { default: "climb", choices: [["climb", "climb"], ["conventional", "conventional"], ["either", "the shorter of both"]], help: "Direction of contours.", fields: ["contour_direction"] }),
  s("spirals", "passes", "flag", "Spirals", { help: "Closed contours around walls become one helical pass.", fields: ["contour_spirals"] }),
  s("one-way", "passes", "flag", "One way", { help: "All zig-zag lines run in one direction.", fields: ["one_way_lines"] }),
  s("bend", "passes", "number", "Lines may turn by", { default: "20", unit: "\u00b0", help: "How far lines may turn from their direction to keep the step-over even, 0 to 30. 0: straight lines.", fields: ["zigzag_bend_deg"], isRare: true }),
  s("no-round-lines", "passes", "flag", "Straight lines on rims, too", { help: "Straight lines also where circular ones would be a tenth shorter.", fields: ["round_lines"], isRare: true }),
  s("no-border-passes", "passes", "flag", "No border passes", { help: "No passes along borders where zig-zag lines end one after the other.", fields: ["border_passes"], isRare: true }),
  s("edges", "passes", "choice", "Open edges", { default: "stop", choices: [["stop", "stop at them"], ["roll", "roll over them"], ["extend", "run beyond them"]], help: "What the ball does at the open edges of the surface.", fields: ["edge_rule"] }),
  s("detail", "passes", "number", "Detail of regions", { default: "0.5", help: "How finely the surface is divided into regions: 0 coarsest, 1 finest.", fields: ["detail"] }),
  s("max-unreached", "passes", "number", "Uncut at most", { unit: "%", hint: "50", help: "Largest share of what looks up that may stay uncut because the ball does not fit.", fields: ["max_unreached_fraction"], isRare: true }),

  s("clearance", "motion", "number", "Clearance", { default: "5", unit: "mm", help: "Height of rapids above the highest of part, stock and clamps.", fields: ["clearance_above_mm"] }),
  s("lead-radius", "motion", "number", "Lead radius", { unit: "mm", hint: "half the ball radius", help: "Radius of the arcs onto passes and off them.", fields: ["leads.radius_mm"] }),
  s("lead-sweep", "motion", "number", "Lead sweep", { unit: "\u00b0", hint: "90", help: "Sweep of these arcs, 10 to 90 degrees.", fields: ["leads.sweep_deg"] }),
  s("lead-feed", "motion", "number", "Lead feed", { unit: "mm/min", hint: "as the feed", help: "Feed of leads.", fields: ["feeds.lead_mm_per_min"] }),
  s("link-feed", "motion", "number", "Link feed", { unit: "mm/min", hint: "as the feed", help: "Feed of links between passes.", fields: ["feeds.link_mm_per_min"] }),
  s("corner-feed", "motion", "number", "Corner feed", { unit: "mm/min", hint: "as the feed", help: "Lowest feed in inner corners of passes, where the ball cuts more than along a straight wall.", fields: ["feeds.corner_mm_per_min"] }),
  s("plunge-angle", "motion", "number", "Plunge feed from", { unit: "\u00b0", hint: "30", help: "Descents steeper than this run at plunge feed, 1 to 30 degrees.", fields: ["feeds.plunge_angle_deg"] }),
  s("keep-feed", "motion", "flag", "Passes keep the feed", { help: "Passes keep the feed on steep descents, too. It needs the allowance or the body of the stock.", fields: ["keep_on_passes"] }),
  s("approach-gap", "motion", "number", "Approach gap", { unit: "mm", hint: "1", help: "Distance from the stock at which a rapid changes to feed.", fields: ["approach_gap_mm"] }),
  s("high-rapids", "motion", "flag", "Rapids at the clearance", { help: "All rapids at the clearance plane. Else they are only as high as needed where the stock is stated.", fields: ["high_rapids"] }),

  s("machine-name", "machine", "text", "Name", { hint: "not stated", help: "Name of the machine for the report.", fields: ["machine.name"] }),
  ...["x", "y", "z"].map((axis, k) => s(`machine-${axis}`, "machine", "text", `Axis ${axis.toUpperCase()}`, { help: "Both ends of the travel, speed of rapids, fastest feed, acceleration.", fields: [`machine.axes[${k}]`, ...(k === 0 ? ["machine.axes"] : [])] })),
  s("machine-spindle", "machine", "text", "Spindle, range", { unit: "1/min", hint: "100,24000", help: "Slowest and fastest speed. Not stated: the speed is not compared.", fields: ["spindle_min_rpm", "spindle_max_rpm"] }),
  s("machine-corner", "machine", "number", "Leaves corners by", { unit: "mm", hint: "0.01", help: "How far the control may leave a corner without stopping there, 0 to 1. 0: it stops at every corner.", fields: ["junction_deviation_mm"] }),
  s("machine-zero", "machine", "text", "Zero on the machine", { unit: "mm", hint: "X,Y,Z", help: "The program zero in machine coordinates, as the tip reaches it. Not stated: only the extent of the motion is compared with the travel.", fields: ["work_zero", "work_zero.x_mm", "work_zero.y_mm", "work_zero.z_mm"] }),

  s("post", "program", "choice", "Control", { default: "linuxcnc", choices: [["linuxcnc", "LinuxCNC (RS274/NGC)"]], help: "The control that the program is written for.", fields: ["post.dialect", "post.post_file"] }),
  s("work-offset", "program", "choice", "Work offset", { default: "G54", choices: ["G54", "G55", "G56", "G57", "G58", "G59"].map((g) => [g, g] as const), help: "Work offset.", fields: ["work_offset"] }),
  s("program-number", "program", "whole", "Program number", { default: "1", help: "For controls that number their programs.", fields: ["program_number"] }),
  s("no-arcs", "program", "flag", "Straight moves only", { help: "No arcs (G2, G3), also where the control has them.", fields: ["post.arcs"] }),
  s("inch", "program", "flag", "In inches", { help: "The program is written in inches (G20). The page stays in mm.", fields: ["post.unit"] }),
  s("restart-points", "program", "flag", "Restart points", { help: "The program has places where the control may be started again.", fields: ["restart_points"] }),
  s("line-numbers", "program", "whole", "Line numbers", { hint: "as the control has them", help: "Step of the line numbers; 0: none.", fields: ["line_number_step"], isRare: true }),
  s("control-deviation", "program", "number", "Leaves the path by", { unit: "mm", hint: "exact stop", help: "By how much the control leaves the path, for controls without a word that states it.", fields: ["control_deviation_mm"], isRare: true }),
];

const byName = new Map(settings.map((setting) => [setting.name, setting]));

export function settingOf(name: string): Setting {
  const setting = byName.get(name);
  if (setting === undefined) throw new Error(`There is no setting "${name}".`);
  return setting;
}

export const isList = ({ kind }: Setting): boolean => kind === "list" || kind === "lines";

// What is chosen. A setting that is at its default is not in it.
export class Choice {
  readonly #values = new Map<string, string[]>();

  // The text of a setting: what was chosen, or its default.
  get(name: string): string {
    return this.#values.get(name)?.[0] ?? settingOf(name).default;
  }

  list(name: string): readonly string[] {
    return this.#values.get(name) ?? [];
  }

  isSet(name: string): boolean {
    return this.#values.has(name);
  }

  set(name: string, ...values: string[]): void {
    const setting = settingOf(name);
    const isOff = (v: string): boolean => v === "" || (setting.kind === "flag" && ["0", "false", "off", "no"].includes(v));
    const kept = values.map((v) => v.trim()).filter((v) => !isOff(v));
    if (kept.length === 0 || (!isList(setting) && kept[0] === setting.default)) this.#values.delete(name);
    else this.#values.set(name, isList(setting) ? [...new Set(kept)] : [kept[0]!]);
  }

  clear(): void {
    this.#values.clear();
  }

  // Adds a value to a list, or takes it out.
  toggle(name: string, value: string, isIn: boolean): void {
    this.set(name, ...this.list(name).filter((v) => v !== value), ...(isIn ? [value] : []));
  }

  // The settings as the part of an address after "#".
  toHash(): string {
    const pairs = new URLSearchParams();
    for (const { name } of settings) for (const value of this.list(name)) pairs.append(name, value);
    return pairs.toString();
  }

  // Returns the names in the address that are no settings.
  fromHash(hash: string): string[] {
    const found = new Map<string, string[]>();
    const unknown: string[] = [];
    for (const [name, value] of new URLSearchParams(hash.replace(/^#/, ""))) {
      const setting = byName.get(name);
      // As on the command line, commas divide names; a region has commas in its place.
      const values = setting?.kind === "list" && name !== "region" ? value.split(",") : [value];
      if (setting !== undefined) found.set(name, [...(found.get(name) ?? []), ...values.map((v) => v.slice(0, 20_000))]);
      else if (name !== "") unknown.push(name);
    }
    this.clear();
    for (const [name, values] of found) this.set(name, ...values);
    return unknown;
  }

  // The settings of these groups as one text, to see whether they changed.
  keyOf(names: readonly string[]): string {
    return names.map((name) => JSON.stringify(this.list(name))).join();
  }
}

const quoted = (text: string): string => (/^[A-Za-z0-9_./:=,@%+-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`);

export const machineFile = "machine.json"; // the command reads the machine from it

// The command that makes the same program.
export function commandOf(choice: Choice, file: string, program: string): string {
  const words = ["patchmill", "mill", quoted(file), "-o", quoted(program)];
  const isMachineSet = settings.some(({ name, group }) => group === "machine" && choice.isSet(name));
  if (isMachineSet) words.push(`--machine=${machineFile}`);
  for (const setting of settings) {
    const { name, kind, group } = setting;
    if (!choice.isSet(name) || group === "machine") continue;
    if (kind === "flag") words.push(`--${name}`);
    else if (kind === "list" && name !== "region") words.push(quoted(`--${name}=${choice.list(name).join(",")}`));
    else for (const value of choice.list(name)) words.push(quoted(`--${name}=${value}`));
  }
  return words.join(" ");
}
