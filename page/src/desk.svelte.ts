/** What lies before somebody: the arm, the source and the plan that the screens work with. Kept for the next time. */
import { arm as armOf, arms } from "./api/calls";
import type { ArmInfo, ArmWhole } from "./api/types";
import { keep, kept } from "./kept";

class Desk {
	/** SHA-256 of an arm file or a result; null: none chosen. */
	arm = $state<string | null>(kept("arm"));
	/** A URL, or the SHA-256 of a source file. */
	source = $state<string | null>(kept("source"));
	plan = $state<string | null>(kept("plan"));
	info = $state.raw<ArmInfo | null>(null);
	private whole = new Map<string, Promise<ArmWhole>>();

	chooseArm(sha256: string): void {
		this.arm = sha256;
		keep("arm", sha256);
		void this.look();
	}

	chooseSource(source: string): void {
		this.source = source;
		keep("source", source);
	}

	choosePlan(sha256: string): void {
		this.plan = sha256;
		keep("plan", sha256);
	}

	/** What the chosen arm is; forgotten where it is not on the desk any more. */
	async look(): Promise<void> {
		const { arms: all } = await arms();
		this.info = all.find((each) => each.sha256 === this.arm) ?? null;
		if (!this.info) this.arm = null;
	}

	/** With its picture; content that is named by its hash never changes, so it is asked for once. */
	wholeOf(sha256: string): Promise<ArmWhole> {
		const known = this.whole.get(sha256);
		if (known) return known;
		const asked = armOf(sha256);
		this.whole.set(sha256, asked);
		asked.catch(() => this.whole.delete(sha256));
		return asked;
	}
}

export const desk = new Desk();
