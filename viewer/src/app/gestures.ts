/** Double-click and double-tap on the picture; wheel and pinch take hold of the surface under them. */
import type { Stage } from "../scene/stage";

const DOUBLE_TAP_MS = 320;
const DOUBLE_TAP_PX = 28;
const WHEEL_PAUSE_MS = 250;

export function watchPointer(stage: Stage, onDouble: (clientX: number, clientY: number) => void): void {
  const { canvas } = stage;
  const fingers = new Map<number, PointerEvent>();
  let lastTap: PointerEvent | null = null;
  let isTap = false;

  canvas.addEventListener("dblclick", (event) => {
    // touch has its own below: not every browser sends double-clicks for taps
    if ((event as PointerEvent).pointerType !== "touch" && !lastTap) onDouble(event.clientX, event.clientY);
  });
  canvas.addEventListener(
    "pointerdown",
    (event) => {
      canvas.focus({ preventScroll: true });
      if (event.pointerType !== "touch") {
        lastTap = null;
        return;
      }
      fingers.set(event.pointerId, event);
      isTap = fingers.size === 1;
      if (fingers.size === 2) {
        const [a, b] = [...fingers.values()] as [PointerEvent, PointerEvent];
        stage.anchor((a.clientX + b.clientX) / 2, (a.clientY + b.clientY) / 2);
      }
    },
    { capture: true },
  );
  addEventListener("pointerup", (event) => {
    const began = fingers.get(event.pointerId);
    fingers.delete(event.pointerId);
    if (
      !began ||
      !isTap ||
      apart(began, event) > DOUBLE_TAP_PX ||
      event.timeStamp - began.timeStamp > DOUBLE_TAP_MS
    )
      return;
    const isSecond =
      lastTap !== null &&
      event.timeStamp - lastTap.timeStamp < DOUBLE_TAP_MS &&
      apart(lastTap, event) < DOUBLE_TAP_PX;
    lastTap = isSecond ? null : event;
    if (isSecond) onDouble(event.clientX, event.clientY);
  });
  addEventListener("pointercancel", (event) => fingers.delete(event.pointerId));
}

/** Wheel: bring the pivot to the surface under the cursor, once a gesture, before the camera hears of it. */
export function watchWheel(stage: Stage): void {
  let last = Number.NEGATIVE_INFINITY;
  const onWheel = (event: WheelEvent): void => {
    const isSameGesture = event.timeStamp - last < WHEEL_PAUSE_MS;
    last = event.timeStamp;
    if (!isSameGesture) stage.anchor(event.clientX, event.clientY);
  };
  stage.canvas.addEventListener("wheel", onWheel, { capture: true, passive: true });
}

function apart(a: PointerEvent, b: PointerEvent): number {
  return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
}
