/** All that the page says, in one table, so that another language is another table. */
export const WORDS = {
  home: "Home view",
  upAxis: (axis: string) => `Up axis: ${axis}`,
  colours: "Colours",
  wireframe: "Wireframe",
  patches: "Patch colours",
  spheres: "Bounding spheres",
  refinement: "Refinement",
  light: "Light and shadows",
  ownLight: "The scene's own light",
  edges: "Shadow edges",
  timeOfDay: "Time of day",
  sceneLight: "Back to the scene's own",
  faceColours: "Colour by level",
  inset: "The mesh from elsewhere",
  insetTurns: "The mesh from elsewhere: arrow keys or dragging turn it.",
  answersAgain: "The server answers again.",
  refinedHere: "refined where you look",
  update: "update",
  threshold: (factor: string) => `edges × ${factor}`,
  screenshot: "Save picture",
  share: "Copy link to this view",
  fullscreen: "Full screen",
  settings: "Settings",
  theme: "Light or dark",
  status: "Status line",
  help: "Help",
  close: "Close",
  tryAgain: "Try again",
  tools: "Tools",
  views: "Views",
  on: (what: string) => `${what} on`,
  off: (what: string) => `${what} off`,
  themeIs: (name: string) => (name === "dark" ? "Dark" : "Light"),
  linkCopied: "Link copied. It holds this very view.",
  linkHere: "Link to this view",
  pictureSaved: "Picture saved.",
  loading: "Loading",
  loaded: (title: string) => `${title} is shown. Detail arrives where you look.`,
  allDetail: "All detail for this view is here.",
  wholeFile: "The server has no ranges, so the whole file was read once.",
  pivot: "The view now turns about this point.",
  nothingThere: "There is nothing to turn about here.",
  lost: "The graphics were lost. The picture comes back as soon as the browser allows.",
  restored: "The graphics are back.",
  foreignLink: "This link was made by a newer version; the home view is shown.",
  still: "still",
  failed: "The model cannot be shown",
  canvas: (title: string) => `${title}, three-dimensional view`,
  instructions:
    "Arrow keys turn the model, Shift and arrow keys move it, plus and minus zoom, F shows all of it. H opens help.",
  triangles: "triangles",
  faces: "faces",
  loadedOf: (bytes: string, all: string) => `${bytes} of ${all}`,
  received: "received",
  error: "error",
  framesPerSecond: "frames/s",
  layer: (name: string) => `Layer ${name}`,
} as const;

export const SCHEME_NAMES = {
  sqrt3: "√3 subdivision",
  loop: "Loop subdivision as an RGB triangulation",
  butterfly: "Modified butterfly subdivision as an RGB triangulation",
  "catmull-clark": "The Catmull-Clark surface",
} as const;

/** By which patches get their depth. */
export const RULE_NAMES = {
  curvature: "Deeper where the surface bends",
  backs: "Backs not subdivided",
  silhouettes: "Silhouettes deeper",
  size: "By how large they look",
} as const;

/** Rows of the help page: what to do, with the mouse, by touch, by keys. */
export const HELP_ROWS: readonly (readonly [string, string, string, string])[] = [
  ["Turn", "Drag", "One finger", "← → ↑ ↓"],
  ["Move", "Right drag, or Shift and drag", "Two or three fingers", "Shift and arrows"],
  ["Zoom", "Wheel, to the pointer", "Pinch", "+ −"],
  ["Turn about a point", "Double-click it", "Double-tap it", "Enter: the middle"],
  ["See all of it", "Home button", "Home button", "F or Home"],
];

/** Keys beside those of the table above. */
export const HELP_KEYS: readonly (readonly [string, string])[] = [
  ["U", "up axis"],
  ["C", "colours"],
  ["W", "wireframe"],
  ["P", "patch colours"],
  ["B", "bounding spheres"],
  ["S", "save picture"],
  ["L", "copy link"],
  ["X", "full screen"],
  ["O", "settings"],
  ["T", "light or dark"],
  ["I", "status line"],
  ["H", "this help"],
  ["1 – 9", "named views"],
  ["Esc", "close"],
];

/** How shadows are looked up. */
export const FILTER_NAMES = {
  hard: "Hard",
  "3x3": "3 × 3 pixels",
  "5x5": "5 × 5 pixels",
  smooth: "Smooth",
  soft: "Soft",
} as const;

/** Of the light of a scene, by what its file calls it. */
export const LIGHT_NAMES: Readonly<Record<string, string>> = {
  directional: "Parallel light",
  sun: "Sunlight",
  spot: "A spot light",
  point: "A light that shines everywhere",
  area: "A light with a surface",
  sun_path: "A day's sunlight",
};

/** Keys for the light of a scene. */
export const LIGHT_KEYS: typeof HELP_KEYS = [["D", "light and shadows"]];

/** Keys for what is refined where it is looked at. */
export const REFINEMENT_KEYS: typeof HELP_KEYS = [
  ["R", "refinement"],
  ["M", "colour by level"],
  ["E", "mesh from elsewhere"],
];

/** From where the scene is seen, e.g. "front, left, from above". */
export function directionWords(right: number, up: number, front: number): string {
  const words: string[] = [];
  const flat = Math.hypot(right, front);
  if (flat > 0.35) {
    if (Math.abs(front) > 0.4 * flat) words.push(front > 0 ? "front" : "back");
    if (Math.abs(right) > 0.4 * flat) words.push(right > 0 ? "right" : "left");
  }
  if (Math.abs(up) > 0.35) words.push(up > 0 ? "from above" : "from below");
  return words.join(", ");
}
