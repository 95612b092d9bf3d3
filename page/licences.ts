import { existsSync, readdirSync, readFileSync } from "node:fs";
import { join, sep } from "node:path";
import type { Plugin } from "vite";

/** Licences under which something may be shipped with Ulna. */
const ALLOWED = ["MIT", "ISC", "BSD-2-Clause", "BSD-3-Clause", "Apache-2.0", "0BSD"];
const WHERE = `${sep}node_modules${sep}`;

/** The folder of the package that a module is of; null of our own. */
export function packageOf(id: string): string | null {
	const at = id.lastIndexOf(WHERE);
	if (at < 0) return null;
	const [first = "", second = ""] = id.slice(at + WHERE.length).split(sep);
	return id.slice(0, at + WHERE.length) + (first.startsWith("@") ? join(first, second) : first);
}

/** What is said of a package: its name, version, licence and the licence's text. Throws where it may not be shipped. */
export function licence(folder: string): string {
	const said = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
	if (!ALLOWED.includes(said.license)) {
		throw new Error(`${said.name}: licence ${said.license}; expected one of ${ALLOWED.join(", ")}`);
	}
	const file = existsSync(folder) && readdirSync(folder).find((name) => /^licen[cs]e(\.|$)/i.test(name));
	const text = file ? readFileSync(join(folder, file), "utf8").trim() : "";
	return `${said.name} ${said.version}: ${said.license}\n\n${text}`;
}

/** Writes licences.txt: of every package from which something is in the page. */
export function licences(): Plugin {
	return {
		name: "licences",
		generateBundle(_, bundle) {
			const folders = new Set<string>();
			for (const each of Object.values(bundle)) {
				if (each.type !== "chunk") continue;
				for (const id of each.moduleIds) {
					const folder = packageOf(id);
					if (folder !== null) folders.add(folder);
				}
			}
			const source = [...folders]
				.sort()
				.map(licence)
				.join(`\n\n${"-".repeat(72)}\n\n`);
			this.emitFile({ type: "asset", fileName: "licences.txt", source: `${source}\n` });
		},
	};
}
