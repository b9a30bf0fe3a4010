/** The text of src/format/patch.wasm.ts. */
export function compile(): Promise<string>;
