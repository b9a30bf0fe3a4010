import { describe, expect, it } from "vitest";
import { fovFile, HEADER } from "../format/small.fixture";
import { openAsset } from "./asset";
import { type Fetch, Passing, Source } from "./source";

/** A server in a function. */
function serve(
  file: Uint8Array<ArrayBuffer>,
  options: { hasRanges?: boolean; tag?: () => string; fail?: number[] } = {},
) {
  const { hasRanges = true, tag = () => '"one"', fail = [] } = options;
  const asked: string[] = [];
  const fetch: Fetch = async (_url, init) => {
    const headers = init.headers as Record<string, string>;
    asked.push(headers.Range!);
    const status = fail.shift();
    if (status === 0) throw new TypeError("network");
    if (status !== undefined) return new Response(null, { status });
    const [, start, last] = /bytes=(\d+)-(\d+)/.exec(headers.Range!)!;
    const end = Math.min(Number(last) + 1, file.length);
    const isStale = headers["If-Range"] !== undefined && headers["If-Range"] !== tag();
    if (!hasRanges || isStale) return new Response(file, { status: 200, headers: { ETag: tag() } });
    if (Number(start) >= file.length) return new Response(null, { status: 416 });
    return new Response(file.slice(Number(start), end), {
      status: 206,
      headers: { ETag: tag(), "Content-Range": `bytes ${start}-${end - 1}/${file.length}` },
    });
  };
  return { fetch, asked };
}

const big = new Uint8Array(200_000).map((_, i) => i % 251);
const open = (fetch: Fetch) =>
  Source.open("https://example.test/a/statue.fov?x=1", undefined, undefined, fetch);

describe("source", () => {
  it("reads ranges, and what came first not again", async () => {
    const { fetch, asked } = serve(big);
    const source = await open(fetch);
    expect(source.name).toBe("statue.fov");
    expect(source.size).toBe(big.length);
    expect(await source.read(5, 50)).toEqual(big.subarray(5, 50));
    expect(await source.read(100_000, 100_010)).toEqual(big.subarray(100_000, 100_010));
    expect(asked).toEqual(["bytes=0-65535", "bytes=100000-100009"]);
    expect(source.received).toBe(65_546);
  });

  it("reads the whole once where the server has no ranges", async () => {
    const { fetch, asked } = serve(big, { hasRanges: false });
    const source = await open(fetch);
    expect(source.whole).toEqual(big);
    expect(await source.read(199_990, 200_000)).toEqual(big.subarray(199_990));
    expect(asked.length).toBe(1);
  });

  it("never mixes two versions of a file", async () => {
    let tag = '"one"';
    const { fetch } = serve(big, { tag: () => tag });
    const source = await open(fetch);
    tag = '"two"';
    await expect(source.read(100_000, 100_100)).rejects.toMatchObject({ kind: "changed" });
  });

  it("tells what may pass from what will not", async () => {
    await expect(open(serve(big, { fail: [404] }).fetch)).rejects.toMatchObject({ kind: "missing" });
    await expect(open(serve(big, { fail: [403] }).fetch)).rejects.toMatchObject({ kind: "missing" });
    for (const status of [0, 500, 503, 429]) {
      await expect(open(serve(big, { fail: [status] }).fetch)).rejects.toBeInstanceOf(Passing);
    }
  });
});

describe("asset", () => {
  it("opens, with a server that fails twice", async () => {
    const { fetch, asked } = serve(fovFile(), { fail: [0, 503] });
    const asset = await openAsset("https://example.test/small.fov", { fetch });
    expect(asset.graph.nodes).toBe(2);
    expect([...asset.nodeBytes]).toEqual([3 * 12 + 6, 4 * 12 + 12]);
    expect(asked.length).toBe(3);
  });

  it("fetches the rest where header and graph are longer than the first request", async () => {
    const header = { ...HEADER, note: "x".repeat(100_000) };
    const { fetch, asked } = serve(fovFile(header));
    const asset = await openAsset("https://example.test/small.fov", { fetch });
    expect(asset.graph.patches).toBe(2);
    expect(asked.length).toBeGreaterThan(1);
  });

  it("refuses an empty file and one that is cut", async () => {
    await expect(openAsset("x.fov", { fetch: serve(new Uint8Array(0)).fetch })).rejects.toThrow(/not a .fov/);
    const cut = fovFile().slice(0, -4);
    await expect(openAsset("x.fov", { fetch: serve(cut).fetch })).rejects.toThrow(/not copied whole/);
  });
});
