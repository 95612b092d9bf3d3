/** The first address carries a token behind its `#`, which no server log sees: it becomes a cookie, and goes. */
import { about, login, me } from "./api/calls";
import { Refusal, SILENT } from "./api/refusal";
import { bench } from "./bench.svelte";
import { desk } from "./desk.svelte";

export function tokenOf(hash: string): string | null {
	return new URLSearchParams(hash.replace(/^#/, "")).get("token");
}

/** Whether somebody may come in, and what lies on the desk. */
export async function enter(): Promise<void> {
	bench.door = "opening";
	const token = tokenOf(location.hash);
	try {
		if (token) {
			history.replaceState(null, "", location.pathname + location.search);
			await login(token);
		}
		[bench.me, bench.about] = await Promise.all([me(), about()]);
		await Promise.all([desk.look(), bench.find()]);
		if (!desk.arm && bench.activity?.arm) desk.chooseArm(bench.activity.arm);
		bench.door = "open";
	} catch (error) {
		if (!(error instanceof Refusal)) throw error;
		bench.door = error.status === SILENT ? "silent" : "locked";
	}
}
