// Makes the set-up of a job: how the model lies, the stock, the clamps, the machine
// (clients/cli/job_options.cc, stock_option.cc).
import { create } from "@bufbuild/protobuf";
import { Point3Schema } from "../gen/patchmill/v1/geometry_pb.js";
import {
  BlockStockSchema,
  CylinderStockSchema,
  type Obstacle,
  ObstacleSchema,
  OutlineStockSchema,
  type Setup,
  SetupSchema,
  type Stock,
  StockSchema,
  UpAxis,
  type WallSide,
  WallSideSchema,
  ZeroAnchor,
} from "../gen/patchmill/v1/setup_pb.js";
import { makeMachine } from "./machine";
import type { Choice } from "./settings";
import { mustNumber, numberOf, numbersOf, pointOf, ringOf, SettingError, wireText } from "./values";

const axes = new Map<string, UpAxis>(Object.entries({ auto: UpAxis.AUTO, z: UpAxis.Z, y: UpAxis.Y, x: UpAxis.X, "-z": UpAxis.NEG_Z, "-y": UpAxis.NEG_Y, "-x": UpAxis.NEG_X }));
const anchors = new Map<string, ZeroAnchor>(Object.entries({ origin: ZeroAnchor.ORIGIN, "top-center": ZeroAnchor.TOP_CENTER, "bottom-corner": ZeroAnchor.BOTTOM_CORNER }));

function makeZero(text: string): Setup["zero"] {
  if (text === "") return { case: undefined };
  const anchor = anchors.get(text);
  if (anchor !== undefined) return { case: "zeroAnchor", value: anchor };
  const point = pointOf(numbersOf(text, [3], "zero", "origin, top-center, bottom-corner or X,Y,Z"));
  return { case: "programZero", value: create(Point3Schema, point) };
}

// "block[,MARGIN]", "cylinder,D[,X,Y]" or "outline: X,Y X,Y X,Y".
function makeBody(text: string): Stock["body"] {
  const [, kind = "", rest = ""] = /^(\w*)(.*)$/s.exec(text)!;
  if (kind === "outline" && rest.startsWith(":")) {
    return { case: "outline", value: create(OutlineStockSchema, { outlineXyMm: ringOf(rest.slice(1), "stock") }) };
  }
  const wanted = "block, block,MARGIN, cylinder,D, cylinder,D,X,Y or outline: X,Y X,Y X,Y";
  const wrong = new SettingError("stock", `"${text.slice(0, 60)}" must be ${wanted}.`);
  if (kind === "cylinder" && /^,?\s*$/.test(rest)) throw new SettingError("stock", "The round bar has no diameter. State it, above 0 mm.");
  if (rest !== "" && !rest.startsWith(",")) throw wrong;
  const numbers = rest === "" ? [] : numbersOf(rest.slice(1), [1, 3], "stock", wanted);
  if (kind === "block" && numbers.length <= 1) return { case: "block", value: create(BlockStockSchema, { marginMm: numbers[0] ?? 0 }) };
  if (kind === "cylinder") return { case: "cylinder", value: create(CylinderStockSchema, { diameterMm: numbers[0]!, centerXyMm: numbers.slice(1) }) };
  throw wrong;
}

function makeStock(choice: Choice): Stock | undefined {
  const topZMm = numberOf(choice, "stock-top");
  const allowanceMm = numberOf(choice, "allowance");
  const wallAllowanceMm = numberOf(choice, "allowance-walls");
  const floorAllowanceMm = numberOf(choice, "allowance-floors");
  const text = choice.get("stock");
  const stated = Object.entries({ topZMm, allowanceMm, wallAllowanceMm, floorAllowanceMm }).filter(([, value]) => value !== undefined);
  if (stated.length === 0 && text === "") return undefined;
  const stock = create(StockSchema, Object.fromEntries(stated));
  if (text !== "") stock.body = makeBody(text);
  return stock;
}

// "[NAME=]TOP[,MARGIN]: X,Y X,Y X,Y".
function makeObstacle(text: string): Obstacle {
  const colon = text.indexOf(":");
  const wrong = new SettingError("obstacle", `"${text.slice(0, 60)}" must be NAME=TOP,MARGIN: X,Y X,Y X,Y.`);
  if (colon < 0) throw wrong;
  const head = text.slice(0, colon);
  const equals = head.indexOf("=");
  const [topZMm = 0, marginMm = 0] = numbersOf(head.slice(equals + 1), [1, 2], "obstacle", "NAME=TOP,MARGIN: X,Y X,Y X,Y");
  return create(ObstacleSchema, {
    id: equals < 0 ? "" : wireText(head.slice(0, equals), 200),
    topZMm,
    marginMm,
    outlineXyMm: ringOf(text.slice(colon + 1), "obstacle"),
  });
}

// "NAME=X,Y,Z".
function makeWallSide(text: string): WallSide {
  const equals = text.lastIndexOf("=");
  if (equals <= 0) throw new SettingError("wall-side", `"${text.slice(0, 60)}" must be NAME=X,Y,Z.`);
  const air = create(Point3Schema, pointOf(numbersOf(text.slice(equals + 1), [3], "wall-side", "NAME=X,Y,Z")));
  return create(WallSideSchema, { patchId: wireText(text.slice(0, equals), 200), air });
}

// How the model lies.
export function makePlacement(choice: Choice): Setup {
  const up = choice.get("up");
  const axis = axes.get(up);
  const translate = choice.get("translate");
  const capHolesMm = numberOf(choice, "cap-holes");
  return create(SetupSchema, {
    ...(axis === undefined ? { upFace: wireText(up, 200) } : { up: axis }),
    scale: mustNumber(choice, "scale"),
    ...(translate === "" ? {} : { translation: pointOf(numbersOf(translate, [3], "translate", "X,Y,Z")) }),
    ...(capHolesMm === undefined ? {} : { capHolesMm }),
    wallSides: choice.list("wall-side").map(makeWallSide),
    zero: makeZero(choice.get("zero")),
  });
}

export function makeSetup(choice: Choice): Setup {
  const setup = makePlacement(choice);
  const stock = makeStock(choice);
  const machine = makeMachine(choice);
  if (stock !== undefined) setup.stock = stock;
  if (machine !== undefined) setup.machine = machine;
  setup.obstacles = choice.list("obstacle").map(makeObstacle);
  return setup;
}
