/** What the viewer knows of its own work. */
import type { Stage } from "../scene/stage";
import type { Streamer } from "../stream/streamer";
import type { Stats } from "./api";
import type { Figures } from "./statusLine";

const FRAMES = 20;

/** @param frames - Drawn since the page opened. */
export function statsOf(stage: Stage, streamer: Streamer, frames: number): Stats {
  return {
    triangles: stage.painter.drawn.triangles,
    patches: stage.painter.drawn.patches,
    receivedBytes: streamer.receivedBytes,
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
export function figuresOf(stage: Stage, streamer: Streamer): Figures {
  const recent = stage.clock.times.slice(-FRAMES);
  const mean = recent.reduce((sum, time) => sum + time, 0) / (recent.length || 1);
  return {
    triangles: stage.painter.drawn.triangles,
    receivedBytes: streamer.receivedBytes,
    allBytes: allBytes(stage),
    errorPx: stage.errorPx,
    framesPerSecond: stage.isIdle || !recent.length ? null : 1000 / mean,
  };
}

function allBytes(stage: Stage): number {
  return stage.layers.reduce((sum, layer) => sum + layer.fileBytes, 0);
}
