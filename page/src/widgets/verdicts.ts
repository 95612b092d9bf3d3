/** Verdicts of checks and tests, in words and shapes. */
import type { WordKey } from "../words/words.svelte";
import type { Tone } from "./marks";

export const VERDICTS: Record<string, { tone: Tone; word: WordKey }> = {
	pass: { tone: "good", word: "verdict.pass" },
	undecided: { tone: "warn", word: "verdict.undecided" },
	fail: { tone: "bad", word: "verdict.fail" },
};
