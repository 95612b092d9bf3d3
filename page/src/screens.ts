/** The screens in the order in which they are used. A new one is a file and a row. */
import type { Component } from "svelte";
import type { Role } from "./bench.svelte";
import type { IconName } from "./widgets/icons";
import type { WordKey } from "./words/words.svelte";

export interface ScreenRow {
	path: string;
	title: WordKey;
	icon: IconName;
	/** Whether it stands in the bottom bar of a small screen; the others are behind "more". */
	first: boolean;
	/** Who has it; nobody named: all. */
	role?: Role;
	load: () => Promise<{ default: Component }>;
}

export const SCREENS: readonly ScreenRow[] = [
	{
		path: "/",
		title: "screen.bench",
		icon: "bench",
		first: true,
		load: () => import("./screens/Bench.svelte"),
	},
	{ path: "/arm", title: "screen.arm", icon: "arm", first: true, load: () => import("./screens/Arm.svelte") },
	{
		path: "/file",
		title: "screen.file",
		icon: "file",
		first: false,
		load: () => import("./screens/File.svelte"),
	},
	{
		path: "/goal",
		title: "screen.goal",
		icon: "goal",
		first: false,
		load: () => import("./screens/Goal.svelte"),
	},
	{
		path: "/collect",
		title: "screen.collect",
		icon: "collect",
		first: true,
		load: () => import("./screens/Collect.svelte"),
	},
	{
		path: "/results",
		title: "screen.results",
		icon: "results",
		first: true,
		load: () => import("./screens/Results.svelte"),
	},
	{
		path: "/compare",
		title: "screen.compare",
		icon: "compare",
		first: false,
		load: () => import("./screens/Compare.svelte"),
	},
	{
		path: "/read-out",
		title: "screen.read-out",
		icon: "readout",
		first: false,
		load: () => import("./screens/ReadOut.svelte"),
	},
	{
		path: "/check",
		title: "screen.check",
		icon: "check",
		first: false,
		load: () => import("./screens/Check.svelte"),
	},
	{
		path: "/test",
		title: "screen.test",
		icon: "test",
		first: false,
		load: () => import("./screens/Test.svelte"),
	},
	{
		path: "/records",
		title: "screen.records",
		icon: "records",
		first: false,
		load: () => import("./screens/Records.svelte"),
	},
	{
		path: "/certificate",
		title: "screen.certificate",
		icon: "certificate",
		first: false,
		load: () => import("./screens/Certificate.svelte"),
	},
	{
		path: "/people",
		title: "screen.people",
		icon: "person",
		first: false,
		role: "admin",
		load: () => import("./screens/People.svelte"),
	},
];

export function screenOf(path: string): ScreenRow | undefined {
	return SCREENS.find((each) => each.path === path);
}
