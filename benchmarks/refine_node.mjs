// Node's side of the refinement benchmark: the page's √3, bundled from its TypeScript.
//
//   node benchmarks/refine_node.mjs CASE [--rounds N]     one line of JSON, as js/refine_rounds.mjs has it
//   node benchmarks/refine_node.mjs --bundle              the program itself, for a browser's worker

import { readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { fileURLToPath } from "node:url";

const require = createRequire(new URL("../viewer/package.json", import.meta.url));

/** `js/refine_rounds.mjs` with all that it uses: a module, or a script that sets `rounds`. */
async function bundled(format) {
  const { rolldown } = await import(require.resolve("rolldown"));
  const bundle = await rolldown({ input: fileURLToPath(new URL("js/refine_rounds.mjs", import.meta.url)) });
  const { output } = await bundle.generate({ format, name: "rounds" });
  await bundle.close();
  return output[0].code;
}

async function main(words) {
  if (words[0] === "--bundle") {
    console.log(await bundled("iife"));
    return;
  }
  const at = words.indexOf("--rounds");
  const rounds = at < 0 ? 15 : Number(words.splice(at, 2)[1]);
  const code = await bundled("esm");
  const { measure } = await import(`data:text/javascript;base64,${Buffer.from(code).toString("base64")}`);
  console.log(JSON.stringify(measure(JSON.parse(await readFile(words[0], "utf8")), rounds)));
}

await main(process.argv.slice(2));
