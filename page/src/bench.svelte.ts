/** What goes on, as the line tells it: the activity that is looked at, jobs, and who is signed in. */
import { announce } from "./announce.svelte";
import { begin as beginActivity, gate, me, activities as running, say } from "./api/calls";
import { Live } from "./api/live.svelte";
import { reduced } from "./api/reduce";
import { Refusal, SILENT } from "./api/refusal";
import type { About, Activity, Begin, Do, Job, LiveEvent, Me } from "./api/types";
import { keep, kept } from "./kept";
import { sound } from "./tones";
import type { Feed, Frames } from "./widgets/picture";
import { touchLine } from "./widgets/touching";
import { said } from "./words/said.svelte";
import type { WordKey } from "./words/words.svelte";

export type Door = "opening" | "open" | "locked" | "sign-in" | "silent";
export type Role = Me["roles"][number];

class Bench {
	door = $state<Door>("opening");
	about = $state.raw<About | null>(null);
	me = $state.raw<Me | null>(null);
	/** Why somebody who came from elsewhere is not in. */
	why = $state<WordKey | null>(null);
	/** The one that is looked at. */
	activity = $state.raw<Activity | null>(null);
	jobs = $state.raw<Record<string, Job>>({});
	/** Whether the server is of another contract than the page. */
	stale = $state(false);
	readonly live = new Live(address, () => this.known());

	constructor() {
		this.live.onEvent((event) => this.take(event));
		gate.closed = () => {
			if (this.door === "open") this.shut();
		};
	}

	/** Whether it is theirs to do. */
	may(role: Role): boolean {
		return this.me?.roles.includes(role) ?? false;
	}

	/** Whether several people work here, each under their own name. */
	get laboratory(): boolean {
		return this.about?.mode === "laboratory";
	}

	/** Nobody is signed in. */
	shut(): void {
		this.live.close();
		this.me = null;
		this.door = this.laboratory ? "sign-in" : "locked";
	}

	/** The arm's frames, as they come. */
	readonly feed: Feed = (listener: (frames: Frames) => void) =>
		this.live.onFrame((frame) => {
			listener(frame.bodies);
		});

	look(activity: Activity | null): void {
		this.activity = activity;
		if (activity) keep("activity", activity.id);
		this.live.open(activity?.id ?? null);
	}

	/** What runs already, of which this page may have looked at one before; else the newest. */
	async find(): Promise<void> {
		const { running: all } = await running();
		const before = kept("activity");
		this.look(all.find((each) => each.id === before) ?? all[0] ?? null);
	}

	async begin(asked: Begin): Promise<Activity> {
		const made = await beginActivity(asked);
		this.look(made);
		return made;
	}

	/** A word to the activity that is looked at. */
	async say(word: Do): Promise<void> {
		const activity = this.activity;
		if (activity) this.activity = await say(activity.id, word);
	}

	/** A running activity of a kind, or null. */
	of<K extends Activity["state"]["kind"]>(
		kind: K,
	): (Activity & { state: Extract<Activity["state"], { kind: K }> }) | null {
		const activity = this.activity;
		return activity && activity.state.kind === kind
			? (activity as Activity & { state: Extract<Activity["state"], { kind: K }> })
			: null;
	}

	/** Whether this browser is still signed in: a server that began anew knows nobody. */
	private async known(): Promise<boolean> {
		try {
			this.me = await me();
		} catch (error) {
			if (error instanceof Refusal && error.status !== SILENT) {
				this.shut();
				return false;
			}
		}
		return true;
	}

	private take(event: LiveEvent): void {
		this.activity = reduced(this.activity, event);
		switch (event.event) {
			case "hello":
				this.stale = event.contract !== __CONTRACT__;
				break;
			case "touch":
				sound("taken");
				announce([touchLine(event.touch), ...event.sentences.slice(1).map(said)].join(" "));
				break;
			case "refused":
				sound("refused");
				announce(said(event.sentence), true);
				break;
			case "fault":
				announce(said(event.sentence), true);
				break;
			case "job":
				this.jobs = { ...this.jobs, [event.job.id]: event.job };
				break;
			case "said":
				announce(said(event.sentence));
				break;
			case "stream":
			case "tip":
			case "known":
			case "state":
			case "ended":
				break;
		}
	}
}

function address(activity: string | null): string {
	const url = new URL("/api/v1/live", location.href);
	url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
	if (activity) url.searchParams.set("activity", activity);
	return url.href;
}

export const bench = new Bench();
