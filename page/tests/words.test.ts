import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";
import de from "../src/words/de.json";
import en from "../src/words/en.json";
import zh from "../src/words/zh.json";

const SRC = join(import.meta.dirname, "../src");
const CATALOGUES: Record<string, Record<string, string>> = { en, de, zh };
const KEYS = Object.keys(en);

function code(folder: string): string {
	return readdirSync(folder, { withFileTypes: true, recursive: true })
		.filter((each) => each.isFile() && /\.(ts|svelte)$/.test(each.name) && each.name !== "schema.d.ts")
		.map((each) => readFileSync(join(each.parentPath, each.name), "utf8"))
		.join("\n");
}

/** The names in braces, which stay as they are in every language. */
const holes = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map((each) => each[1]).sort();

describe.each(Object.entries(CATALOGUES))("words in %s", (_, catalogue) => {
	it("lack none and have none too many", () => {
		expect(KEYS.filter((key) => !catalogue[key]?.trim())).toEqual([]);
		expect(Object.keys(catalogue).filter((key) => !KEYS.includes(key))).toEqual([]);
	});
	it("have the same holes as the English ones", () => {
		const wrong = KEYS.filter(
			(key) => holes(catalogue[key] ?? "").join() !== holes((en as Record<string, string>)[key] ?? "").join(),
		);
		expect(wrong).toEqual([]);
	});
});

it("each word is used somewhere", () => {
	const all = code(SRC);
	expect(KEYS.filter((key) => !all.includes(`"${key}"`) && !all.includes(`'${key}'`))).toEqual([]);
});
