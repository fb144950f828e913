import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

// The viewer of pages, or the workbench (--mode workbench): one file without anything beside it. The target is what the distribution's browser and those of the last years know.
export default defineConfig(
  ({ mode }) =>
    ({
      plugins: [viteSingleFile({ removeViteModuleLoader: true })],
      build: {
        target: "es2022",
        cssCodeSplit: false,
        assetsInlineLimit: 1 << 30,
        rollupOptions: { input: mode === "workbench" ? "workbench.page.html" : "report.html" },
      },
      oxc: { jsx: { runtime: "automatic", importSource: "preact" } },
    }) as never,
);
