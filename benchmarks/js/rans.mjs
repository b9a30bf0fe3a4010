/** Two interleaved rANS states in JavaScript, for measuring: the stream of `foveal.coding._kernels_rans`. */

/** table[slot] = symbol | frequency << 8 | (slot - start) << 20; frequencies sum to 2^bits. */
export function buildRans(frequencies, bits) {
  const table = new Uint32Array(1 << bits);
  let slot = 0;
  frequencies.forEach((frequency, symbol) => {
    for (let i = 0; i < frequency; i++) table[slot++] = symbol | (frequency << 8) | (i << 20);
  });
  return { bits, table };
}

/** Fill `out`, even places from the first state, from 16-bit `words`; what lacks reads as 0. */
export function decodeRans({ bits, table }, words, out) {
  const mask = (1 << bits) - 1;
  let a = (words[0] | (words[1] << 16)) >>> 0;
  let b = (words[2] | (words[3] << 16)) >>> 0;
  let at = 4;
  const pairs = out.length & ~1;
  for (let i = 0; i < pairs; i += 2) {
    const first = table[a & mask];
    const second = table[b & mask];
    a = (Math.imul((first >>> 8) & 0xfff, a >>> bits) + (first >>> 20)) >>> 0;
    b = (Math.imul((second >>> 8) & 0xfff, b >>> bits) + (second >>> 20)) >>> 0;
    out[i] = first & 255;
    out[i + 1] = second & 255;
    if (a < 65536) a = ((a << 16) | words[at++]) >>> 0;
    if (b < 65536) b = ((b << 16) | words[at++]) >>> 0;
  }
  if (pairs < out.length) out[pairs] = table[a & mask] & 255;
}
