import type { IconName } from "./icons";

export type AlertTone = "note" | "good" | "warn" | "bad";
export const ALERT_ICONS: Record<AlertTone, IconName> = {
	note: "note",
	good: "good",
	warn: "warn",
	bad: "bad",
};
