import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, it } from "vitest";

const ROOT = join(import.meta.dirname, "../..");
const SRC = join(import.meta.dirname, "../src");
const tokens = readFileSync(join(SRC, "look/tokens.css"), "utf8");
const [light = "", dark = ""] = tokens.split(":root[data-look=");
const variables = (css: string) =>
	new Map([...css.matchAll(/--([\w-]+):\s*(#\w+)/g)].map((each) => [each[1], each[2]]));

it("has the colours of the documents", () => {
	const css = readFileSync(join(ROOT, "python/ulna/documents/html/style.css"), "utf8");
	const blocks = [...css.matchAll(/:root(?:\[data-theme="(\w+)"\])? \{([^}]*)\}/g)];
	const documents = {
		light: variables(blocks[0]?.[2] ?? ""),
		dark: variables(blocks.find((each) => each[1] === "dark")?.[2] ?? ""),
	};
	expect(documents.light.size).toBeGreaterThan(10);
	for (const [name, colour] of documents.light)
		expect([name, variables(light).get(name)]).toEqual([name, colour]);
	for (const [name, colour] of documents.dark)
		expect([name, variables(dark).get(name)]).toEqual([name, colour]);
});

it("has the colours of the pictures of arms", () => {
	const looks = readFileSync(join(ROOT, "python/ulna/pictures/looks.py"), "utf8");
	const [, own = "", other = ""] = looks.split(/^(?:LIGHT|DARK) = \{/m);
	const named = (text: string) => [...(text.split("}")[0]?.matchAll(/"([\w-]+)": "(#\w+)"/g) ?? [])];
	expect(named(own).length).toBeGreaterThan(10);
	for (const [, name, colour] of named(own))
		expect([name, variables(light).get(`arm-${name}`)]).toEqual([name, colour]);
	for (const [, name, colour] of named(other))
		expect([name, variables(dark).get(`arm-${name}`)]).toEqual([name, colour]);
});

it("keeps to what the server's policy allows", () => {
	const files = readdirSync(SRC, { recursive: true, withFileTypes: true }).filter((each) =>
		each.name.endsWith(".svelte"),
	);
	expect(files.length).toBeGreaterThan(20);
	for (const file of files) {
		const text = readFileSync(join(file.parentPath, file.name), "utf8");
		expect([
			file.name,
			/\sstyle="|\{@html|\bonclick="[^{]|https?:\/\/(?!127\.0\.0\.1)/.exec(text)?.[0],
		]).toEqual([file.name, undefined]);
	}
});

it("nothing committed names a registry", () => {
	expect(readFileSync(join(ROOT, "page/package-lock.json"), "utf8")).not.toMatch(/"resolved"/);
});
