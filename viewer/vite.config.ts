import { defineConfig } from "vite";

/** Everything the page needs is emitted as local files with relative names, so it works in any folder. */
export default defineConfig({
  base: "./",
  build: {
    outDir: "../src/foveal/viewer",
    emptyOutDir: true,
    target: "es2022",
    assetsDir: "assets",
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 900,
    modulePreload: { polyfill: false },
  },
  worker: { format: "es" },
  server: { host: "127.0.0.1" },
});
