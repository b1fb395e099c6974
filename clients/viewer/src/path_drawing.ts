// A path as it is drawn: its lines, the signs on it and the search for a move under a pixel.
import { Group } from "three";
import { Arrows } from "./arrows";
import { passRanks, type Ranks } from "./density";
import { PathPicker } from "./path_pick";
import type { PathVertices } from "./path_vertices";
import { PathView } from "./path_view";
import type { Path } from "./scene";
import type { SharedUniforms } from "./uniforms";

export class PathDrawing {
  readonly vertices: PathVertices;
  readonly view: PathView;
  readonly arrows: Arrows;
  readonly ranks: Ranks;
  readonly object = new Group();
  #picker: PathPicker | null = null;

  // `size` (mm) is that of the part, `lift` (mm) how far the triangles of the surface may lie above it.
  constructor(path: Path, vertices: PathVertices, size: number, lift: number, shared: SharedUniforms) {
    this.vertices = vertices;
    this.ranks = passRanks(path, vertices);
    this.view = new PathView(vertices, this.ranks.ranks, size, lift, shared);
    this.arrows = new Arrows(path, vertices, size, shared);
    this.object.add(this.view.object, this.arrows.object);
  }

  // Made when something is picked for the first time.
  get picker(): PathPicker {
    this.#picker ??= new PathPicker(this.vertices);
    return this.#picker;
  }
}
