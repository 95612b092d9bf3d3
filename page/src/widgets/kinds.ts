/** Kinds and states of the record, in words. */
import type { WordKey } from "../words/words.svelte";
import type { Tone } from "./marks";

export const EQUIPMENT: Record<string, WordKey> = {
	arm: "equipment.arm",
	robot: "equipment.robot",
	probe: "equipment.probe",
	artefact: "equipment.artefact",
	thermometer: "equipment.thermometer",
};
export const STATES: Record<string, { tone: Tone; word: WordKey }> = {
	"in use": { tone: "good", word: "bench.in-use" },
	quarantined: { tone: "bad", word: "bench.quarantined" },
	retired: { tone: "soft", word: "bench.retired" },
};
