import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Live, waitMs } from "../src/api/live.svelte";

class Socket {
	static all: Socket[] = [];
	onopen: (() => void) | null = null;
	onmessage: ((message: { data: string | ArrayBuffer }) => void) | null = null;
	onclose: ((event: { code: number }) => void) | null = null;
	binaryType = "";
	closed = false;
	constructor(readonly url: string) {
		Socket.all.push(this);
	}
	close() {
		this.closed = true;
	}
}

beforeEach(() => {
	Socket.all = [];
	vi.useFakeTimers();
	vi.stubGlobal("WebSocket", Socket);
	vi.stubGlobal("window", globalThis);
});
afterEach(() => {
	vi.useRealTimers();
	vi.unstubAllGlobals();
});
const last = () => Socket.all.at(-1) as Socket;

describe("the line", () => {
	it("waits longer each time, and never long", () => {
		expect([0, 1, 2, 3, 4, 5, 20].map(waitMs)).toEqual([250, 500, 1000, 2000, 4000, 4000, 4000]);
	});
	it("comes back by itself, and says while it is away", async () => {
		const live = new Live((activity) => `ws://x/${activity}`);
		live.open("a");
		last().onopen?.();
		expect(live.line).toBe("open");
		last().onclose?.({ code: 1006 });
		expect(live.line).toBe("lost");
		await vi.advanceTimersByTimeAsync(300);
		expect(Socket.all.length).toBe(2);
		expect(live.line).toBe("lost");
		last().onopen?.();
		expect(live.line).toBe("open");
	});
	it("does not try again where nobody is signed in", async () => {
		const live = new Live(
			() => "ws://x",
			async () => false,
		);
		live.open(null);
		last().onclose?.({ code: 1006 });
		await vi.advanceTimersByTimeAsync(10000);
		expect(Socket.all.length).toBe(1);
	});
	it("lets an activity go that is not there any more", async () => {
		const live = new Live((activity) => `ws://x/${activity}`);
		live.open("gone");
		last().onopen?.();
		last().onclose?.({ code: 4404 });
		await vi.advanceTimersByTimeAsync(300);
		expect(last().url).toBe("ws://x/null");
	});
	it("tells events to all who listen, and drops what is no frame", () => {
		const live = new Live(() => "ws://x");
		const events: unknown[] = [];
		const frames: unknown[] = [];
		const leave = live.onEvent((event) => events.push(event));
		live.onFrame((frame) => frames.push(frame));
		live.open(null);
		last().onmessage?.({ data: '{"event":"said","sentence":"x"}' });
		last().onmessage?.({ data: new ArrayBuffer(5) });
		leave();
		last().onmessage?.({ data: '{"event":"said","sentence":"y"}' });
		expect(events).toEqual([{ event: "said", sentence: "x" }]);
		expect(frames).toEqual([]);
	});
	it("closes the old one where another activity is looked at", () => {
		const live = new Live((activity) => `ws://x/${activity}`);
		live.open("a");
		const first = last();
		live.open("b");
		expect(first.closed).toBe(true);
		expect(first.onclose).toBeNull();
		live.open("b");
		expect(Socket.all.length).toBe(2);
	});
});
