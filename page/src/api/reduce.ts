/** What an event makes of what is known of an activity. Nothing is worked out: the server's newest word counts. */
import type { Activity, LiveEvent, Sentence, State, Touch, TouchState } from "./types";

/** Sentences that are kept. */
export const SAID = 6;

export function reduced(activity: Activity | null, event: LiveEvent): Activity | null {
	switch (event.event) {
		case "hello":
			return event.activity;
		case "ended":
			return event.activity;
		case "job":
			return activity;
	}
	if (!activity) return null;
	switch (event.event) {
		case "stream":
			return { ...activity, stream: event.stream };
		case "state":
			return { ...activity, state: event.state };
		case "touch":
			// its first sentence is what the list of touches says in every language
			return said(
				touching(activity, (state) => ({ ...state, touches: put(state.touches, event.touch) })),
				event.sentences.slice(1),
			);
		case "known":
			return touching(activity, (state) => ({ ...state, meter: event.meter, next: event.next }));
		case "tip":
			return activity.state.kind === "measure"
				? { ...activity, state: { ...activity.state, tip: event.tip } }
				: activity;
		case "refused":
		case "fault":
		case "said":
			return said(activity, [event.sentence]);
	}
}

function said(activity: Activity, sentences: Sentence[]): Activity {
	return { ...activity, said: [...activity.said, ...sentences].slice(-SAID) };
}

function touching(activity: Activity, change: (state: TouchState) => State): Activity {
	return activity.state.kind === "touch" ? { ...activity, state: change(activity.state) } : activity;
}

/** In place of what has its number, else behind all. */
function put(touches: Touch[], touch: Touch): Touch[] {
	const same = touches.some((each) => each.number === touch.number);
	return same ? touches.map((each) => (each.number === touch.number ? touch : each)) : [...touches, touch];
}
