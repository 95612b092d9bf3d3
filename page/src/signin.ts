/** Who comes in: by a token behind the first address's `#`, which no server log sees and which becomes a cookie; or, in a
 * laboratory, as somebody. */
import { about, login, logout, me } from "./api/calls";
import { Refusal, SILENT } from "./api/refusal";
import { bench } from "./bench.svelte";
import { desk } from "./desk.svelte";
import type { WordKey } from "./words/words.svelte";

export function tokenOf(hash: string): string | null {
	return new URLSearchParams(hash.replace(/^#/, "")).get("token");
}

const CAME_BACK: Record<string, WordKey> = {
	refused: "sign-in.refused",
	silent: "sign-in.silent",
	unknown: "sign-in.unknown",
};

/** Why the provider's way led to nothing, as the server sends a browser back; null where it did not. */
export function cameBack(hash: string): WordKey | null {
	return CAME_BACK[new URLSearchParams(hash.replace(/^#/, "")).get("sign-in") ?? ""] ?? null;
}

/** Whether somebody may come in, and what lies on the desk. */
export async function enter(): Promise<void> {
	bench.door = "opening";
	const token = tokenOf(location.hash);
	bench.why = cameBack(location.hash);
	try {
		if (token || bench.why) history.replaceState(null, "", location.pathname + location.search);
		bench.about = await about();
		if (token) await login({ way: "token", token });
		await inside();
	} catch (error) {
		if (!(error instanceof Refusal)) throw error;
		if (error.status === SILENT) bench.door = "silent";
		else bench.shut();
	}
}

/** As somebody. A no is whoever asked's to show. */
export async function signIn(name: string, password: string): Promise<void> {
	await login({ way: "password", name, password });
	await inside();
}

/** This browser is nobody's any more. */
export async function signOut(): Promise<void> {
	await logout();
	bench.shut();
}

async function inside(): Promise<void> {
	bench.me = await me();
	await Promise.all([desk.look(), bench.find()]);
	if (!desk.arm && bench.activity?.arm) desk.chooseArm(bench.activity.arm);
	bench.why = null;
	bench.door = "open";
}
