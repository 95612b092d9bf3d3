import { readFileSync } from "node:fs";
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vitest/config";
import { contractOf } from "./contract.ts";
import { licences } from "./licences.ts";

const contract = contractOf(readFileSync(new URL("openapi.json", import.meta.url), "utf8"));

/** What the server allows is kept to: nothing inline, no data: URLs, one stylesheet, names by content. */
export default defineConfig({
	define: { __CONTRACT__: JSON.stringify(contract) },
	plugins: [svelte(), licences()],
	build: {
		outDir: "../python/ulna/serve/page",
		emptyOutDir: true,
		target: "es2022",
		assetsInlineLimit: 0,
		cssCodeSplit: false,
		modulePreload: { polyfill: false },
		reportCompressedSize: false,
		chunkSizeWarningLimit: 700,
	},
	server: { proxy: { "/api": { target: "http://127.0.0.1:8765", ws: true } } },
	test: { include: ["tests/**/*.test.ts"], environment: "node" },
});
