import { createHash } from "node:crypto";

/** What page and server must agree on: SHA-256 of the schema without its version, as `contract` of
 * python/ulna/serve/app.py has it. It is taken of the text itself, as JSON knows 1.0 and 1 for the same number. */
export function contractOf(openapi: string): string {
	const same = openapi
		.trim()
		.replace(/\n "info": \{[\s\S]*?\n \}/, '\n "info": {}')
		.replace(/,\n */g, ", ")
		.replace(/\n */g, "");
	return createHash("sha256").update(same).digest("hex");
}
