/// <reference types="vitest/config" />
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import react from "@vitejs/plugin-react";
import { defineConfig, type Plugin } from "vite";

/** Where the studio's server listens while the pages are served by Vite. */
const server = process.env["HANDLOOM_SERVER"] ?? "http://127.0.0.1:8000";

/** Packs what the build wrote, once and well; the server sends the packed file to browsers that take it. */
const packed = (folder: string): Plugin => ({
  name: "packed",
  apply: "build",
  closeBundle() {
    for (const name of readdirSync(folder, { recursive: true, encoding: "utf-8" })) {
      if (!/\.(js|css|html|svg|json)$/.test(name)) continue;
      const path = join(folder, name);
      const data = readFileSync(path);
      if (data.length < 1000) continue;
      writeFileSync(`${path}.br`, brotliCompressSync(data, { params: { [constants.BROTLI_PARAM_SIZE_HINT]: data.length } }));
      writeFileSync(`${path}.gz`, gzipSync(data, { level: 9 }));
    }
  },
});

export default defineConfig({
  plugins: [react(), packed(join(import.meta.dirname, "dist"))],
  server: {
    proxy: {
      "/api": { target: server },
      "/viewer": { target: server, ws: true },
    },
  },
  build: {
    chunkSizeWarningLimit: 900,
    rolldownOptions: {
      output: {
        codeSplitting: {
          // A group takes along what its own modules need, so React has the first word: the first page needs no canvas.
          groups: [
            { name: "react", priority: 3, test: /node_modules[\\/](react|react-dom|react-router|scheduler|@tanstack)[\\/]/ },
            { name: "mantine", priority: 2, test: /node_modules[\\/]@mantine/ },
            { name: "canvas", test: /node_modules[\\/](konva|react-konva|its-fine|react-reconciler)/ },
            { name: "three", test: /node_modules[\\/]three[\\/]/ },
          ],
        },
      },
    },
  },
  // One process for all files: a process for each took five times as long, and no file leaves anything that others see.
  test: { environment: "node", include: ["src/**/*.test.ts", "src/**/*.test.tsx"], pool: "threads", isolate: false },
});
