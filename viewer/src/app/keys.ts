/** Keys to actions, by place on the keyboard, so that they work on every layout. */
export interface KeyActions {
  orbit(right: number, up: number): void;
  pan(right: number, up: number): void;
  zoom(factor: number): void;
  /** Go to the named view of this number; whether there is one. */
  view(number: number): boolean;
  /** Run the tool that has this letter; whether there is one. */
  tool(letter: string): boolean;
}

const DEGREES = 10;
const SHARE = 0.08;
const ZOOM = 1.25;

const ARROWS: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

export type KeyPress = Pick<KeyboardEvent, "code" | "key" | "shiftKey" | "ctrlKey" | "altKey" | "metaKey">;

/** Do what the key stands for; whether it stood for anything. */
export function pressKey(event: KeyPress, actions: KeyActions): boolean {
  if (event.ctrlKey || event.altKey || event.metaKey) return false;
  const arrow = ARROWS[event.code];
  if (arrow) {
    if (event.shiftKey) actions.pan(arrow[0] * SHARE, arrow[1] * SHARE);
    else actions.orbit(arrow[0] * DEGREES, arrow[1] * DEGREES);
    return true;
  }
  const isPlus = event.code === "Equal" || event.code === "NumpadAdd" || event.key === "+";
  const isMinus = event.code === "Minus" || event.code === "NumpadSubtract" || event.key === "-";
  if (isPlus || isMinus) {
    actions.zoom(isPlus ? ZOOM : 1 / ZOOM);
    return true;
  }
  if (event.key === "?") return actions.tool("H");
  if (event.shiftKey) return false;
  if (event.code === "Home") return actions.tool("F");
  const digit = /^(?:Digit|Numpad)([1-9])$/.exec(event.code)?.[1];
  if (digit) return actions.view(Number(digit));
  const letter = /^Key([A-Z])$/.exec(event.code)?.[1];
  return letter ? actions.tool(letter) : false;
}

/** Whether keys pressed here belong to a field that takes text or a slider that takes arrows. */
export function isField(target: EventTarget | null): boolean {
  return (
    target instanceof HTMLElement &&
    (target.isContentEditable || target.closest("input, textarea, select") !== null)
  );
}
