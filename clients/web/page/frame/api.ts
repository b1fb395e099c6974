// What the page and the frame with the viewer say to each other. Both are of one origin, so they call each other.
export interface View {
  yaw: number;
  pitch: number;
  height: number;
  target: [number, number, number];
  isOrthographic: boolean;
  shading: string | null;
}

// What was clicked on the part.
export interface Clicked {
  surface: string | null; // name of the face or patch
  region: number | null; // Region.id
}

export interface Shown {
  isProgram: boolean;
  isDark: boolean;
  view: View | null; // to go on with; null: the whole part is fitted in
  isFitted: boolean; // the whole is fitted in, seen from where it was
  onClick: (clicked: Clicked) => void;
  onFile: (file: File) => void;
  onTheme: (isDark: boolean) => void;
}

export type Mark = "none" | "milled" | "avoided";

export interface FrameApi {
  // Throws an error for the user if the scene cannot be shown.
  show: (header: unknown, block: ArrayBuffer, shown: Shown) => void;
  view: () => View;
  setDark: (isDark: boolean) => void;
  setPicking: (isPicking: boolean) => void; // clicks choose faces or regions
  mark: (marks: ReadonlyMap<string, Mark>, isAllMilled: boolean) => void; // by the name of the surface
  shade: (id: string) => void;
  findPlace: (code: string, message: string) => void; // turns to the place of a finding
  state: () => Record<string, unknown>;
  pick: (x: number, y: number) => unknown;
  project: (point: [number, number, number]) => { x: number; y: number };
  setTime: (seconds: number) => void;
  pixel: (x: number, y: number) => number[];
}

export interface FrameWindow extends Window {
  patchmillFrame?: FrameApi;
}
