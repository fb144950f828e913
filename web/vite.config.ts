import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// One file without anything beside it. The target is what the distribution's browser and those of the last years know.
export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  build: { target: "es2022", cssCodeSplit: false, assetsInlineLimit: 1 << 30, rollupOptions: { input: "report.html" } },
  oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
} as never);
