/** Whoever holds an arm does not look: high is taken, low is refused. */
import { keep, kept } from "./kept";

export type Tone = "taken" | "refused" | "done";
/** Hz and s of each note, one after the other. */
const NOTES: Record<Tone, readonly (readonly [number, number])[]> = {
	taken: [[1046, 0.12]],
	refused: [[196, 0.28]],
	done: [
		[784, 0.12],
		[1046, 0.22],
	],
};
const LOUD = 0.25;
let context: AudioContext | null = null;

export function audible(): boolean {
	return kept("tones") !== "off";
}

export function hear(on: boolean): void {
	keep("tones", on ? "on" : "off");
}

/** Browsers are silent until somebody touches the page: called at each key and click until it works. */
export function wake(): void {
	context ??= typeof AudioContext === "undefined" ? null : new AudioContext();
	if (context?.state === "suspended") void context.resume();
}

export function sound(tone: Tone): void {
	if (!audible()) return;
	wake();
	if (context?.state !== "running") return;
	let at = context.currentTime;
	for (const [hertz, seconds] of NOTES[tone]) {
		const note = context.createOscillator();
		const volume = context.createGain();
		note.frequency.value = hertz;
		volume.gain.setValueAtTime(LOUD, at);
		volume.gain.exponentialRampToValueAtTime(0.001, at + seconds);
		note.connect(volume).connect(context.destination);
		note.start(at);
		note.stop(at + seconds);
		at += seconds;
	}
}
