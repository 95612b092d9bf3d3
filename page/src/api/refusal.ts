/** A server's no, in its own words (RFC 9457), or that there is no server. */
export class Refusal extends Error {
	constructor(
		readonly status: number,
		message: string,
	) {
		super(message);
		this.name = "Refusal";
	}
}

/** No answer came. */
export const SILENT = 0;

/** The sentence in a problem; of anything else what can be said. */
export function detailOf(problem: unknown, status: number): string {
	if (typeof problem === "object" && problem !== null) {
		if ("detail" in problem && typeof problem.detail === "string" && problem.detail) return problem.detail;
		if ("title" in problem && typeof problem.title === "string" && problem.title) return problem.title;
	}
	return `HTTP ${status}`;
}
