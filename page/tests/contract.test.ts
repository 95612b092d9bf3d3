import { expect, it } from "vitest";
import { contractOf } from "../contract";

/** Made by Python: `json.dumps(document, indent=1, sort_keys=True)`, and the hash of `json.dumps(…, sort_keys=True)`
 * with an empty "info". */
const TEXT =
	'{\n "a": [\n  1.0,\n  {\n   "b": "x\\ny, z"\n  },\n  [],\n  {}\n ],\n "info": {\n  "title": "T",\n  "version": "1"\n },\n "z": true\n}\n';

it("names a contract as the server does", () => {
	expect(contractOf(TEXT)).toBe("f788d476d7667eacd2db1773a2b5205fd45428377ba8c7aae8f0673e0b5cfcd0");
});

it("does not mind another version", () => {
	expect(contractOf(TEXT.replace('"version": "1"', '"version": "2"'))).toBe(contractOf(TEXT));
	expect(contractOf(TEXT.replace("true", "false"))).not.toBe(contractOf(TEXT));
});
