/** The line to the server: events, and the newest frame. It comes back by itself, and says while it is away. */
import { type Frame, frameOf } from "./frame";
import type { LiveEvent } from "./types";

export type Line = "closed" | "opening" | "open" | "lost";
const FIRST_MS = 250;
const MOST_MS = 4000;
/** There is no such activity any more. */
const NOT_THERE = 4404;

/** How long to wait before trying again, after so many tries in vain. */
export function waitMs(tries: number): number {
	return Math.min(MOST_MS, FIRST_MS * 2 ** tries);
}

export class Live {
	line = $state<Line>("closed");
	private socket: WebSocket | null = null;
	private tries = 0;
	private timer = 0;
	private activity: string | null = null;
	private readonly events = new Set<(event: LiveEvent) => void>();
	private readonly frames = new Set<(frame: Frame) => void>();

	constructor(
		private readonly url: (activity: string | null) => string,
		/** Asked where it could not be opened: whether to try again. */
		private readonly again: () => Promise<boolean> = async () => true,
	) {}

	/** Opens it, or looks at another activity. */
	open(activity: string | null): void {
		if (this.socket && this.activity === activity) return;
		this.activity = activity;
		this.tries = 0;
		this.dial();
	}

	close(): void {
		clearTimeout(this.timer);
		this.hang();
		this.line = "closed";
	}

	onEvent(listener: (event: LiveEvent) => void): () => void {
		this.events.add(listener);
		return () => this.events.delete(listener);
	}

	onFrame(listener: (frame: Frame) => void): () => void {
		this.frames.add(listener);
		return () => this.frames.delete(listener);
	}

	private hang(): void {
		const socket = this.socket;
		this.socket = null;
		if (socket) {
			socket.onopen = socket.onmessage = socket.onclose = null;
			socket.close();
		}
	}

	private dial(): void {
		clearTimeout(this.timer);
		this.hang();
		if (this.line !== "lost") this.line = "opening";
		const socket = new WebSocket(this.url(this.activity));
		let opened = false;
		socket.binaryType = "arraybuffer";
		socket.onopen = () => {
			this.line = "open";
			this.tries = 0;
			opened = true;
		};
		socket.onmessage = (message: MessageEvent<string | ArrayBuffer>) => {
			if (typeof message.data === "string") {
				const event = JSON.parse(message.data) as LiveEvent;
				for (const listener of this.events) listener(event);
				return;
			}
			const frame = frameOf(message.data);
			if (frame) for (const listener of this.frames) listener(frame);
		};
		socket.onclose = async (event) => {
			this.socket = null;
			this.line = "lost";
			if (event.code === NOT_THERE) this.activity = null;
			// a browser does not say why a socket was refused
			if (opened || (await this.again()))
				this.timer = window.setTimeout(() => this.dial(), waitMs(this.tries++));
		};
		this.socket = socket;
	}
}
