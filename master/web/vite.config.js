import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  build: { target: "es2022", chunkSizeWarningLimit: 700, emptyOutDir: true },
  // The API of a running master, for `npx vite` while working on the app.
  server: { proxy: { "/api": { target: "http://127.0.0.1:5412", ws: true } } },
});
