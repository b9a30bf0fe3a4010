/** Canonical Huffman codes in JavaScript, for measuring: a look-up a symbol, as in `foveal.coding.huffman`. */

/** table[next maxBits bits] = symbol * 16 + length of its code. */
export function buildHuffman(lengths, maxBits) {
  const table = new Uint16Array(1 << maxBits);
  const order = [...lengths.keys()].filter((s) => lengths[s] > 0);
  order.sort((a, b) => lengths[a] - lengths[b] || a - b);
  let code = 0;
  let before = 0;
  for (const symbol of order) {
    const length = lengths[symbol];
    code <<= length - before;
    let first = 0;
    for (let k = 0; k < length; k++) first |= ((code >> k) & 1) << (length - 1 - k);
    for (let index = first; index < table.length; index += 1 << length) table[index] = symbol * 16 + length;
    code++;
    before = length;
  }
  return { maxBits, table };
}

/** Fill `out` from `bytes`; throws a RangeError where they end too early. */
export function decodeHuffman({ maxBits, table }, bytes, out) {
  const mask = (1 << maxBits) - 1;
  let held = 0;
  let filled = 0;
  let next = 0;
  for (let i = 0; i < out.length; i++) {
    while (filled < maxBits) {
      held |= (next < bytes.length ? bytes[next] : 0) << filled;
      next++;
      filled += 8;
    }
    const entry = table[held & mask];
    out[i] = entry >> 4;
    held >>>= entry & 15;
    filled -= entry & 15;
  }
  if (8 * next - filled > 8 * bytes.length) throw new RangeError("the codes end too early");
}
