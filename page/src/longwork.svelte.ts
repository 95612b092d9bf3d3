/** Long work that was asked for here: its job, as the line tells it, and what it made. */
import { beginJob } from "./api/calls";
import type { BeginJob, Job } from "./api/types";
import { bench } from "./bench.svelte";

export class LongWork {
	private name = $state<string | null>(null);
	/** Null as long as nothing was asked for. */
	readonly job = $derived<Job | null>(this.name === null ? null : (bench.jobs[this.name] ?? null));

	/** Raises a Refusal. */
	async begin(body: BeginJob): Promise<void> {
		const begun = await beginJob(body);
		// what the line has told of it already is newer
		bench.jobs = { [begun.id]: begun, ...bench.jobs };
		this.name = begun.id;
	}

	/** What it made in a role, once it is done. */
	made(role: string): Job["made"][number] | null {
		return this.job?.state === "done" ? (this.job.made.find((each) => each.role === role) ?? null) : null;
	}

	forget(): void {
		this.name = null;
	}
}
