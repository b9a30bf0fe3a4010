/** What the viewer knows of its own work. */
import type { Stage } from "../scene/stage";
import type { RefinementFigures } from "../stream/refinement";
import type { Streamer } from "../stream/streamer";
import type { Stats } from "./api";
import type { Figures } from "./statusLine";

const FRAMES = 20;

/** What is said of several refinements together: the sums, and the largest threshold. */
export function sumOf(all: readonly RefinementFigures[]): RefinementFigures | null {
  if (!all.length) return null;
  return all.reduce((a, b) => ({
    triangles: a.triangles + b.triangles,
    milliseconds: a.milliseconds + b.milliseconds,
    threshold: Math.max(a.threshold, b.threshold),
    updates: a.updates + b.updates,
    receivedBytes: a.receivedBytes + b.receivedBytes,
  }));
}

/**
 * @param refinement - Of what is refined where it is looked at, or null.
 * @param frames - Drawn since the page opened.
 */
export function statsOf(
  stage: Stage,
  streamer: Streamer,
  refinement: RefinementFigures | null,
  frames: number,
): Stats {
  return {
    refinement,
    triangles: stage.painter.drawn.triangles,
    patches: stage.painter.drawn.patches,
    receivedBytes: receivedBytes(stage, streamer),
    allBytes: allBytes(stage),
    cacheBytes: streamer.cachedBytes,
    cacheNodes: streamer.cachedNodes,
    memoryBudgetBytes: streamer.budgetBytes,
    triangleBudget: stage.triangleBudget,
    errorPx: stage.errorPx,
    targetPx: stage.targetPx,
    motionTriangles: stage.motion.triangles,
    inFlight: streamer.inFlight,
    frameTimes: [...stage.clock.times],
    frames,
    gpu: stage.painter.counts,
    moments: stage.moments,
    isWholeFile: stage.layers.some((layer) => layer.isWholeFile),
  };
}

/** What the status line shows of it. */
export function figuresOf(stage: Stage, streamer: Streamer, refinement: RefinementFigures | null): Figures {
  const recent = stage.clock.times.slice(-FRAMES);
  const mean = recent.reduce((sum, time) => sum + time, 0) / (recent.length || 1);
  return {
    triangles: stage.painter.drawn.triangles,
    receivedBytes: receivedBytes(stage, streamer),
    allBytes: stage.layers.some((layer) => layer.hasPatches) ? allBytes(stage) : null,
    errorPx: stage.layers.some((layer) => layer.hasPatches) ? stage.errorPx : null,
    refinement,
    framesPerSecond: stage.isIdle || !recent.length ? null : 1000 / mean,
  };
}

function receivedBytes(stage: Stage, streamer: Streamer): number {
  return stage.layers.reduce((sum, layer) => sum + layer.receivedBytes, streamer.receivedBytes);
}

function allBytes(stage: Stage): number {
  return stage.layers.reduce((sum, layer) => sum + layer.fileBytes, 0);
}
