import type { Stream } from "../api/types";

/** How much was wrong with a stream so far, of all kinds. */
export function troubles(stream: Stream): number {
	return Object.values(stream.faults).reduce((sum, each) => sum + each, 0);
}
