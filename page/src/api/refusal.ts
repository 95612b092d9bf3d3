import type { Sentence } from "./types";

/** A server's no, in its own words (RFC 9457), or that there is no server. */
export class Refusal extends Error {
	constructor(
		readonly status: number,
		readonly sentence: Sentence,
	) {
		super(sentence.text);
		this.name = "Refusal";
	}
}

/** No answer came. */
export const SILENT = 0;

/** The sentence in a problem; of anything else what can be said. */
export function detailOf(problem: unknown, status: number): Sentence {
	if (typeof problem === "object" && problem !== null) {
		if ("said" in problem && isSentence(problem.said)) return problem.said;
		if ("detail" in problem && typeof problem.detail === "string" && problem.detail)
			return { text: problem.detail };
		if ("title" in problem && typeof problem.title === "string" && problem.title)
			return { text: problem.title };
	}
	return { text: `HTTP ${status}` };
}

function isSentence(said: unknown): said is Sentence {
	return typeof said === "object" && said !== null && "text" in said && typeof said.text === "string";
}
