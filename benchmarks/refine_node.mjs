// Node's side of the benchmarks of refinement: the page's own, bundled from its TypeScript.
//
//   node benchmarks/refine_node.mjs CASE [--rounds N]     one line of JSON, as js/refine_rounds.mjs has it
//   node benchmarks/refine_node.mjs --bundle              the program itself, for a browser's worker
//
// With --script slates_rounds it is Catmull-Clark patches, not √3.

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const require = createRequire(new URL("../viewer/package.json", import.meta.url));

/** A script of `js` with all that it uses: a module, or a script that sets `rounds`. */
async function bundled(script, format) {
  const { rolldown } = await import(require.resolve("rolldown"));
  const bundle = await rolldown({ input: fileURLToPath(new URL(`js/${script}.mjs`, import.meta.url)) });
  const { output } = await bundle.generate({ format, name: "rounds" });
  await bundle.close();
  return output[0].code;
}

/** The word after an option, both taken out. */
function taken(words, option) {
  const at = words.indexOf(option);
  return at < 0 ? undefined : words.splice(at, 2)[1];
}

async function main(words) {
  const script = taken(words, "--script") ?? "refine_rounds";
  const rounds = Number(taken(words, "--rounds") ?? 15);
  if (words[0] === "--bundle") {
    console.log(await bundled(script, "iife"));
    return;
  }
  const code = await bundled(script, "esm");
  const { measure } = await import(`data:text/javascript;base64,${Buffer.from(code).toString("base64")}`);
  console.log(JSON.stringify(measure(JSON.parse(await readFile(words[0], "utf8")), rounds)));
}

await main(process.argv.slice(2));
